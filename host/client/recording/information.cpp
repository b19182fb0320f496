#include "host/client/recording/information.hpp"

#include <dlfcn.h>

#include <fmt/format.h>

#include "host/client/device/event.hpp"
#include "host/client/recording/sha256.hpp"
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

/// Returns the library or program that contains this function.
std::filesystem::path file_of_this_code() {
  Dl_info about{};
  const bool is_known = ::dladdr(reinterpret_cast<const void*>(&is_default_arm), &about) != 0;
  // The dynamic linker knows the main program only by the name in its arguments.
  const std::filesystem::path file = is_known ? about.dli_fname : "";
  return file.is_absolute() && std::filesystem::exists(file) ? file : "/proc/self/exe";
}

}  // namespace

Information describe(const device::Information& device, const protocol::ParameterSet& parameters,
                     std::vector<protocol::Signal> signals, const std::string& arm, bool simulation,
                     const Origin& origin) {
  static const std::string library_sha256 = sha256_of_file(file_of_this_code());
  return {.name = protocol::plain_text(origin.name),
          .note = protocol::plain_text(origin.note),
          .created_utc = device::clock_utc_now(),
          .library_version = INKWELL_VERSION,
          .library_sha256 = library_sha256,
          .image_sha256 = sha256_of_file(origin.image),
          .arm_sha256 = sha256_of_file(origin.arm_description),
          .image_check = device.report.image_check == 0 ? "" : fmt::format("{:08x}", device.report.image_check),
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
