#include "host/companion/window/device_desk/motor_heat_view.hpp"

#include <fmt/format.h>

namespace inkwell::window {

namespace {
constexpr float warm_from = protocol::motor_heat_limits_from;
constexpr float hot_from = 1.0f;
}  // namespace

MotorHeatView motor_heat_view(const protocol::InformationReport& report) {
  MotorHeatView view;
  for (int i = 0; i < 3; ++i) {
    if (report.motor_heat[i] <= view.hottest) continue;
    view.hottest = report.motor_heat[i];
    view.motor = i + 1;
  }
  if (view.hottest >= warm_from) view.level = HeatLevel::warm;
  if (view.hottest >= hot_from) view.level = HeatLevel::hot;
  return view;
}

std::string heat_advice(const MotorHeatView& heat) {
  switch (heat.level) {
    case HeatLevel::cool: return {};
    case HeatLevel::warm:
      return fmt::format(
          "Above {:.0f} % motor heat, the current of motor {} is reduced, and the force may be weaker. Push less or "
          "pause.",
          100.0f * protocol::motor_heat_limits_from, heat.motor);
    case HeatLevel::hot:
      return fmt::format(
          "Motor {} has reached its heat limit, and its current is limited to the continuous current. Switch the force "
          "off "
          "until the motor has cooled, or lower the force limit.",
          heat.motor);
  }
  return {};
}

}  // namespace inkwell::window
