#include "firmware/usb/controller_report.hpp"

namespace inkwell::usb {

namespace {

/// Rounds to the nearest step and limits the result to the range. NaN becomes the upper limit.
std::int16_t steps(float value, float per_unit) {
  const float wanted = value * per_unit;
  const float bounded = wanted < protocol::controller_steps_maximum ? wanted : protocol::controller_steps_maximum;
  const float step = bounded > -protocol::controller_steps_maximum ? bounded : -protocol::controller_steps_maximum;
  return static_cast<std::int16_t>(step < 0.0f ? step - 0.5f : step + 0.5f);
}

}  // namespace

protocol::ControllerReport controller_report(const protocol::PoseReport& pose) {
  constexpr float per_m = 1.0f / protocol::controller_position_step_m;
  constexpr float per_rad = 1.0f / protocol::controller_angle_step_rad;
  constexpr auto buttons =
      static_cast<unsigned>(protocol::Switch::button_1) | static_cast<unsigned>(protocol::Switch::button_2);
  protocol::ControllerReport report{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (pose.is_referenced != 0) report.position[i] = steps(pose.position_m[i], per_m);
    report.angle[i] = steps(pose.gimbal_rad[i], per_rad);
  }
  report.buttons = static_cast<std::uint16_t>(pose.switches & buttons);
  return report;
}

}  // namespace inkwell::usb
