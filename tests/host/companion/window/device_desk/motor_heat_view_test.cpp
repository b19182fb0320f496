#include <string>

#include <doctest/doctest.h>

#include "host/companion/window/device_desk/motor_heat_view.hpp"

using namespace inkwell;
using namespace inkwell::window;

TEST_CASE("the heat advice names the hottest motor, and for a hot motor recommends switching the force off") {
  protocol::InformationReport report{};
  CHECK(heat_advice(motor_heat_view(report)).empty());
  report.motor_heat[1] = 0.85f;
  CHECK(motor_heat_view(report).level == HeatLevel::warm);
  CHECK(motor_heat_view(report).motor == 2);
  report.motor_heat[2] = 1.2f;
  const MotorHeatView heat = motor_heat_view(report);
  CHECK(heat.level == HeatLevel::hot);
  CHECK(heat_advice(heat).find("Motor 3") == 0);
  CHECK(heat_advice(heat).find("off") != std::string::npos);
}
