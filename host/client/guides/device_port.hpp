// The interface between a guide and a device. No function waits. The window, the command line and tests can therefore
// run the same guides.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/device.hpp"
#include "protocol/reports.hpp"

namespace inkwell::guides {

/// State of the device at one moment.
struct Observation {
  bool connected = false;
  std::string message;  ///< state of the connection, with a remedy if available
  std::optional<device::Information> information;
  bool is_simulation = false;
  std::optional<device::Pose> pose;  ///< the newest pose
  std::optional<protocol::ParameterSet> parameters;
  std::uint64_t parameters_revision = 0;  ///< increases with each read, which follows each transaction
  std::optional<std::string> refusal;     ///< reason for refusal of the newest transaction, if refused
};

class DevicePort {
 public:
  virtual ~DevicePort() = default;
  virtual void send(protocol::Command command) = 0;
  virtual void send(protocol::Command command, const protocol::TestPulse& pulse) = 0;
  /// Sends one transaction. Unlike a command, a transaction survives a reconnection.
  virtual void set_parameters(std::vector<device::ParameterChange> changes) = 0;
  /// Selects the guide's scope signals; an empty list returns the scope to its previous user.
  virtual void select_signals(std::vector<protocol::Signal> signals) = 0;
};

}  // namespace inkwell::guides
