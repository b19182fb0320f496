// Memory protection unit regions for the test firmwares.
#pragma once

#include "tests/boards/stm32f405/firmware/support.hpp"

inline constexpr std::uint32_t shcsr = 0xE000ED24, cfsr = 0xE000ED28, hfsr = 0xE000ED2C, mmfar = 0xE000ED34,
                               mpu_control = 0xE000ED94, mpu_number = 0xE000ED98, mpu_base = 0xE000ED9C,
                               mpu_attributes = 0xE000EDA0;
inline constexpr std::uint32_t enable = 1, above_cpu_faults_too = 2, default_map = 4;
inline constexpr std::uint32_t normal = 3u << 16, device = 1u << 16, execute_never = 1u << 28;
enum Rights : std::uint32_t { none = 0, all_privileged = 1, all = 3, read_only = 6 };
/// SIZE field of a region of 2^bits bytes.
constexpr std::uint32_t size(unsigned bits) { return (bits - 1) << 1; }

inline void barrier() { asm volatile("dsb\n isb" ::: "memory"); }

inline void set_region(std::uint32_t number, std::uint32_t base, std::uint32_t attributes) {
  word(mpu_base) = base | 1 << 4 | number;
  word(mpu_attributes) = attributes | 1;
  barrier();
}
inline void set_rights(std::uint32_t number, std::uint32_t base, unsigned bits, Rights rights,
                       std::uint32_t more = normal) {
  set_region(number, base, rights << 24 | size(bits) | more);
}
inline void take_regions_away() {
  word(mpu_control) = 0;
  for (std::uint32_t number = 0; number < 8; ++number) {
    word(mpu_number) = number;
    word(mpu_attributes) = 0;
  }
  barrier();
}
inline void protect(std::uint32_t control) {
  word(mpu_control) = control;
  barrier();
}
