// Evaluates the motor heat for display.
#pragma once

#include <string>

#include "protocol/reports.hpp"

namespace inkwell::window {

enum class HeatLevel : std::uint8_t { cool, warm, hot };

struct MotorHeatView {
  float hottest = 0.0f;  ///< 1 is the steady-state heat at the continuous current
  int motor = 1;
  HeatLevel level = HeatLevel::cool;
};

MotorHeatView motor_heat_view(const protocol::InformationReport& report);

/// Returns advice for the user; empty if the motors are cool.
std::string heat_advice(const MotorHeatView& heat);

}  // namespace inkwell::window
