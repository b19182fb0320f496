#include <doctest/doctest.h>

#include <stdexcept>
#include "boards/stm32f405/peripherals/pin_name.hpp"

using inkwell::virtual_board::PinName;

TEST_CASE("pins are PA0 to PI15, and nothing else is a pin") {
  CHECK(PinName::of("PI15").text() == "PI15");
  CHECK(PinName::of("PB4") == PinName{'B', 4});
  for (const char* wrong : {"", "A8", "PA", "PA16", "PJ0", "P@0", "pa8", "QA8", "PA-1", "PA1x", "PA100"}) {
    CAPTURE(wrong);
    CHECK_FALSE(PinName::find(wrong));
    CHECK_THROWS_WITH_AS(PinName::of(wrong), doctest::Contains("is not a pin; pins are PA0 to PI15."),
                         std::invalid_argument);
  }
}
