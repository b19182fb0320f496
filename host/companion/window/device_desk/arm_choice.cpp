#include "host/companion/window/device_desk/arm_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace inkwell::window {

std::optional<device::Endpoint> ArmChoice::pick(const std::vector<device::Endpoint>& found) {
  if (found.empty()) return std::nullopt;
  const auto named = [&](const std::string& number) -> std::optional<device::Endpoint> {
    const auto match = std::ranges::find(found, number, &device::Endpoint::serial_number);
    return match == found.end() ? std::nullopt : std::optional(*match);
  };
  if (!wanted_.empty()) return named(wanted_);
  // A USB/IP server does not list the serial numbers of its arms.
  const bool have_numbers = std::ranges::none_of(found, &std::string::empty, &device::Endpoint::serial_number);
  if (!have_numbers) return found.front();
  saw_several_ |= found.size() > 1;
  if (auto same = taken_.empty() ? std::nullopt : named(taken_)) return same;
  if (found.size() > 1)
    throw device::NoDevice(fmt::format(
        "{} arms are plugged in. Choose an arm. To change the arm later, use the device list in the status bar.",
        found.size()));
  if (saw_several_ && !taken_.empty())
    throw device::NoDevice(
        fmt::format("The arm {} is disconnected, but the arm {} is connected. Plug in the first arm again, or choose "
                    "the second arm.",
                    taken_, found.front().serial_number));
  taken_ = found.front().serial_number;
  return found.front();
}

}  // namespace inkwell::window
