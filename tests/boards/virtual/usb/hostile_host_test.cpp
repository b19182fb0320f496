// Tests the flashed firmware with a host that violates the protocol. `build/pc/usb-trial hostile --cases N` runs more
// cases.
#include <doctest/doctest.h>

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"
#include "tests/boards/virtual/usb/hostile_host.hpp"

namespace inkwell::virtual_usb_test {

TEST_CASE("ten thousand cases of a hostile host leave the device well, and no request gets another one's answer") {
  const HostileOutcome outcome = be_hostile(flashed_image(), 0, hostile_cases_in_a_row, 3);
  for (const auto& failure : outcome.failures) FAIL_CHECK(failure);
  CHECK(outcome.cases == hostile_cases_in_a_row);
  CHECK(outcome.answers > 3'000);
  CHECK(outcome.wrong_answers == 0);
  CHECK(outcome.missing_answers == 0);
  CHECK(outcome.stalled_answers < outcome.answers / 1'000);
}

}  // namespace inkwell::virtual_usb_test
