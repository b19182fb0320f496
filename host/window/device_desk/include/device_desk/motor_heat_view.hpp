// The heat of the motors, judged for the user.
#pragma once

#include <string>

#include <protocol/reports.hpp>

namespace inkwell::window {

enum class HeatLevel : std::uint8_t { cool, warm, hot };

struct MotorHeatView {
  float hottest = 0.0f;  ///< 1 is what the continuous current leads to
  int motor = 1;         ///< the one that is hottest
  HeatLevel level = HeatLevel::cool;
};

MotorHeatView motor_heat_view(const protocol::InformationReport& report);

/// What to do about it, in a sentence; empty while there is nothing to do.
std::string heat_advice(const MotorHeatView& heat);

}  // namespace inkwell::window
