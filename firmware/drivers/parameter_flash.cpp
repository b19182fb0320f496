#include "firmware/drivers/parameter_flash.hpp"

#include <board/board.hpp>
#include "firmware/drivers/cycle_counter.hpp"

namespace inkwell::drivers {
namespace {

using Flash = RegistersOf<ParameterFlash, registers::FLASH_PROGRAMMING>;

constexpr std::uint32_t first_key = 0x4567'0123, second_key = 0xCDEF'89AB;
constexpr std::uint32_t flash_base = 0x0800'0000, sector_bytes = 0x4000;
constexpr std::uint32_t by_words = 2;  // PSIZE, for a supply of 2.7 V or more
/// Time limit for flash operations. The limit is reached only if the flash is broken.
constexpr std::uint32_t patience_cycles = 2 * board::processor_Hz;

void unlock() {
  if (Flash::CR::LOCK::read() == 0) return;
  Flash::KEYR::write(first_key);
  Flash::KEYR::write(second_key);
}

bool finish() {
  asm volatile("dsb" ::: "memory");
  const bool ended = wait_for(patience_cycles, [] { return Flash::SR::BSY::read() == 0; });
  Flash::CR::write(Flash::CR::LOCK(1));
  return ended;
}

/// The data cache may contain old data (RM0090, "Flash memory erase sequences"). The cache must be disabled during its
/// reset.
void forget_cached_data() {
  using ACR = registers::FLASH::ACR;
  ACR::modify(ACR::DCEN(0));
  ACR::modify(ACR::DCRST(1));
  ACR::modify(ACR::DCRST(0));
  ACR::modify(ACR::DCEN(1));
}

}  // namespace

bool ParameterFlash::program(volatile std::uint32_t* address, std::uint32_t value) {
  unlock();
  Flash::SR::write(Flash::SR::all_errors);
  Flash::CR::write(Flash::CR::PSIZE(by_words), Flash::CR::PG(1));
  *address = value;
  const bool ended = finish();
  forget_cached_data();
  return ended && *address == value;
}

void ParameterFlash::erase(const volatile std::uint32_t* begin) {
  const std::uint32_t number = (reinterpret_cast<std::uint32_t>(begin) - flash_base) / sector_bytes;
  unlock();
  Flash::SR::write(Flash::SR::all_errors);
  Flash::CR::write(Flash::CR::PSIZE(by_words), Flash::CR::SER(1), Flash::CR::SNB(number));
  Flash::CR::modify(Flash::CR::STRT(1));
  finish();
  forget_cached_data();
}

}  // namespace inkwell::drivers
