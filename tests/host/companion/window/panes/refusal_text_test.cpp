// The window shows labels and millimeters, while files and commands use names and meters.
#include <doctest/doctest.h>

#include "host/client/device/device.hpp"
#include "host/companion/window/frame/shown_unit.hpp"
#include "host/companion/window/panes/refusal_text.hpp"

using namespace inkwell;
using protocol::Parameter;

TEST_CASE("only meters are shown in another unit") {
  CHECK(window::shown_unit("m").name == "mm");
  CHECK(window::shown_unit("m").factor == 1000.0f);
  for (const char* unit : {"N", "N/m", "m/s", "rad", ""}) {
    CHECK(window::shown_unit(unit).name == unit);
    CHECK(window::shown_unit(unit).factor == 1.0f);
  }
}

TEST_CASE("a range has the unit of the window") {
  CHECK(window::range_text(protocol::info(Parameter::wall_stiffness_N_per_m)) == "0 to 3000 N/m");
  CHECK(window::range_text(protocol::info(Parameter::box_minimum_x_m)).ends_with(" mm"));
}

TEST_CASE("the device's refusal is shown with the label and the unit of the window") {
  protocol::TransactionReport report{};
  report.parameter_id = protocol::info(Parameter::box_minimum_x_m).id;
  report.value = 0.2f;
  report.refusal = protocol::Refusal::out_of_range;
  const std::string shown = window::refusal_text(device::Refused(report).what());
  CAPTURE(shown);
  CHECK(shown.starts_with("The device refused Box minimum x = 200 mm: "));
  CHECK(shown.ends_with(" mm."));
  CHECK(shown.find("_m") == std::string::npos);
  CHECK(window::refusal_text("Another sentence.") == "Another sentence.");
}
