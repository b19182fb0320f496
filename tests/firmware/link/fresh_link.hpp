// One Link for all tests, made new for each: its scope frames fill half of the chip's memory.
#pragma once

#include <cstdint>
#include <new>

#include <link/link.hpp>

namespace inkwell::test {

inline constexpr std::uint32_t cycles_per_period = 8400;

inline link::Link& fresh_link() {
  alignas(link::Link) static std::byte storage[sizeof(link::Link)];
  return *new (storage) link::Link(cycles_per_period);
}

}  // namespace inkwell::test
