// What a recording says about itself: device, firmware, arm, parameters, and what its columns hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <device/device.hpp>
#include <protocol/parameters.hpp>
#include <protocol/signals.hpp>
#include <protocol/simulation.hpp>

namespace inkwell::recording {

/// Rises when the layout of the files changes.
inline constexpr int format_version = 1;
inline constexpr char format_name[] = "inkwell recording";

struct Information {
  std::string created_utc;  ///< ISO 8601
  std::string firmware_version;
  std::uint16_t protocol_version = protocol::protocol_version;
  std::string serial_number;
  std::string arm;          ///< its name, as far as it is known
  bool simulation = false;  ///< recorded from a virtual board
  /// The device's protocol::ForceLawReport: rows of parameters and signals beside the tables'. Null if none is known.
  std::shared_ptr<const std::vector<std::byte>> force_law;
  protocol::ParameterSet parameters{};
  std::vector<protocol::Signal> signals;
  /// Control periods from one sample to the next: 1 in what the scope gave, more in a black box.
  std::uint32_t step_periods = 1;
  /// What a simulation knew beside them. No device tells these, so a replay passes them over.
  std::vector<protocol::SimulatedQuantity> simulated;
};

/// What is to be written about a recording that starts now. An empty `arm` is recognized by the parameters if it is the
/// one that their defaults describe.
Information describe(const device::Information& device, const protocol::ParameterSet& parameters,
                     std::vector<protocol::Signal> signals, const std::string& arm, bool simulation);

}  // namespace inkwell::recording
