#include "firmware/application/ram_test.hpp"

#include "firmware/self_test/ram_pattern.hpp"

#include <array>
#include <span>

#include "firmware/application/memory.hpp"

namespace inkwell::application {
namespace {

/// Reserved stack space below `room`.
constexpr std::ptrdiff_t words_of_callees = 64;

std::span<volatile std::uint32_t> between(std::uint32_t* begin, std::uint32_t* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

bool ram_retains_pattern() {
  std::array<std::uint32_t, 128> room;
  std::uint32_t* stack = room.data();
  asm("" : "+r"(stack));  // hides from the compiler that memory below the array is used
  bool is_intact = link::retains_pattern(std::span<volatile std::uint32_t>(room));
  is_intact &= link::retains_pattern(between(stack_bottom, stack - words_of_callees), std::span(room));
  is_intact &= link::retains_pattern(between(stack_top, core_coupled_end), std::span(room));
  is_intact &= link::retains_pattern(between(ram_begin, ram_end), std::span(room));
  is_intact &= link::retains_pattern(between(sram2_begin, sram2_end), std::span(room));
  return is_intact;
}

}  // namespace inkwell::application
