#include "firmware/drivers/memory_protection.hpp"

#include <cstdint>

#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using registers::MPU;

enum class Use { none, data, tables, code };

struct Region {
  std::uint32_t base;       ///< a multiple of the size
  std::uint32_t size_bits;  ///< base-2 logarithm of the size in bytes
  Use use;
  bool is_shared;                         ///< as PM0214 specifies for SRAM (table "Memory region attributes for STM32")
  std::uint32_t disabled_subregions = 0;  ///< one bit per eighth of the region, lowest address first
};

constexpr std::uint32_t bits_of_2_KB = 11, bits_of_32_KB = 15, bits_of_64_KB = 16, bits_of_128_KB = 17,
                        bits_of_1_MB = 20, bits_of_32_MB = 25, bits_of_256_MB = 28;

/// The interrupt code is in the third to sixth of eight 8-KB parts.
constexpr std::uint32_t all_but_interrupt_code = 0b1100'0011;

/// If regions overlap, the last region applies. The default memory map applies outside the regions (RM0090, "Memory
/// map").
constexpr Region regions[] = {
    {0x0000'0000, bits_of_256_MB, Use::none, false},  // up to the stack: null pointers, and SRAM1 at address 0
    {0x0800'0000, bits_of_1_MB, Use::code, false},    // flash
    {0x0800'8000, bits_of_32_KB, Use::data, false},   // flash sectors for parameters
    {0x1000'F800, bits_of_2_KB, Use::tables, false},  // core-coupled memory: tables that interrupts read
    {0x2000'0000, bits_of_128_KB, Use::data, true},   // SRAM1 and SRAM2
    {0x0001'0000, bits_of_64_KB, Use::code, true, all_but_interrupt_code},  // SRAM1 at address 0: interrupt code
    {0x2001'0000, bits_of_64_KB, Use::none, true, all_but_interrupt_code},  // SRAM1: the same memory
    {0x2200'0000, bits_of_32_MB, Use::none, true},                          // bit-band alias of the SRAM
};

}  // namespace

void protect_memory() {
  constexpr std::uint32_t nobody = 0b000, reads_and_writes = 0b011, reads = 0b110;
  std::uint32_t number = 0;
  for (const Region& region : regions) {
    const std::uint32_t access = region.use == Use::none ? nobody : region.use == Use::data ? reads_and_writes : reads;
    MPU::RNR::write(MPU::RNR::REGION(number++));
    MPU::RBAR::write(region.base);
    MPU::RASR::write(MPU::RASR::ENABLE(1), MPU::RASR::SIZE(region.size_bits - 1),
                     MPU::RASR::SRD(region.disabled_subregions), MPU::RASR::C(1),
                     MPU::RASR::S(region.is_shared ? 1 : 0), MPU::RASR::AP(access),
                     MPU::RASR::XN(region.use == Use::code ? 0 : 1));
  }
  MPU::CTRL::write(MPU::CTRL::ENABLE(1), MPU::CTRL::PRIVDEFENA(1));
  asm volatile("dsb\n isb" ::: "memory");
}

}  // namespace inkwell::drivers
