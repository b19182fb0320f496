#include "host/client/recording/information.hpp"

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>

#include "protocol/plain_text.hpp"

namespace inkwell::recording {

namespace {

/// Returns true if geometry, motors and gimbal match the default arm.
bool is_default_arm(const protocol::ParameterSet& parameters) {
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
    const auto& row = protocol::known_parameters()[i];
    if ((row.group == "arm" || row.group == "gimbal") && parameters.values[i] != row.default_value) return false;
  }
  return true;
}

}  // namespace

Information describe(const device::Information& device, const protocol::ParameterSet& parameters,
                     std::vector<protocol::Signal> signals, const std::string& arm, bool simulation) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {.created_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)),
          .firmware_version = device.firmware_version,
          .protocol_version = device.protocol_version,
          .serial_number = device.serial_number,
          .arm = arm.empty() && is_default_arm(parameters) ? arm_defaults::name : protocol::plain_text(arm),
          .simulation = simulation,
          .force_law = device.force_law ? device.force_law->report : nullptr,
          .parameters = parameters,
          .signals = std::move(signals),
          .step_periods = 1,
          .simulated = {}};
}

}  // namespace inkwell::recording
