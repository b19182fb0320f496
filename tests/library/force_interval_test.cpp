// Tests the time in which the board interpolates a program's forces.
#include <doctest/doctest.h>

#include "host/bindings/library/force_interval.hpp"

namespace inkwell::tests {
namespace {

TEST_CASE("a program that answers each pose has an interval of one, also after a pose that it answered late") {
  library::ForceInterval interval;
  std::uint32_t sequence = 0xFFFFFF00;  // the sequence wraps
  for (int i = 0; i < 600; ++i) {
    sequence += i % 10 == 0 ? 7 : 1;
    CHECK(interval.next(sequence) == 1);
  }
}

TEST_CASE("the force interval follows a program with a lower rate, and a pause does not change the interval") {
  library::ForceInterval interval;
  std::uint32_t sequence = 0;
  const auto after = [&](std::uint32_t passed) { return interval.next(sequence += passed); };
  after(10);  // the first force has no predecessor
  for (int i = 0; i < 3; ++i) after(10);
  CHECK(after(10) == 10);
  for (const std::uint32_t passed : {51u, 1000u, 0u, 0u, 0u, 0u, 0u}) CHECK(after(passed) == 10);
  CHECK(after(1) == 10);
  for (int i = 0; i < 3; ++i) after(50);
  CHECK(after(50) == 50);
  for (int i = 0; i < 3; ++i) after(1);
  CHECK(after(1) == 1);
}

}  // namespace
}  // namespace inkwell::tests
