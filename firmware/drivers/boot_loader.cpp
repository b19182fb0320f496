#include "firmware/drivers/boot_loader.hpp"

#include <cstdint>

#include "firmware/drivers/system.hpp"

namespace inkwell::drivers {
namespace {

constexpr std::uint32_t mark = 0x64667521;

/// The memory is undefined after power-on, so the request is stored twice.
struct Wish {
  std::uint32_t mark;
  std::uint32_t inverted;
};

[[gnu::noinit]] Wish wish;

/// Address of the boot loader. The first two words of the boot loader are its stack pointer and entry address.
constexpr std::uint32_t system_memory = 0x1FFF'0000;

}  // namespace

void start_boot_loader() {
  wish = {mark, ~mark};
  reset_chip();
}

bool take_boot_loader_wish() {
  const bool is_wanted = wish.mark == mark && wish.inverted == ~mark;
  wish = {};
  return is_wanted;
}

extern "C" void enter_boot_loader() {
  asm volatile(
      "ldr r1, [%0] \n"
      "ldr r0, [%0, #4] \n"
      "msr msp, r1 \n"
      "bx r0 \n" ::"r"(system_memory)
      : "r0", "r1");
  __builtin_unreachable();
}

}  // namespace inkwell::drivers
