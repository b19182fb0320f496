#include <recording/information.hpp>

#include <chrono>
#include <ctime>

#include <fmt/chrono.h>

namespace inkwell::recording {

Information describe(const device::Information& device, const protocol::ParameterSet& parameters,
                     std::vector<protocol::Signal> signals, const std::string& arm, bool simulation) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {.created_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)),
          .firmware_version = device.firmware_version,
          .protocol_version = device.protocol_version,
          .serial_number = device.serial_number,
          .arm = arm,
          .simulation = simulation,
          .parameters = parameters,
          .signals = std::move(signals)};
}

}  // namespace inkwell::recording
