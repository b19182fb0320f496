// What a guide sees of a device, and what it asks of it. Nothing here waits, so that the window and the command
// line run the same guides, and tests run them without a device.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <device/device.hpp>
#include <protocol/reports.hpp>

namespace inkwell::guides {

/// The device at one moment.
struct Observation {
  bool connected = false;
  std::string message;  ///< about the connection, with the remedy where there is one
  std::optional<device::Information> information;
  std::optional<device::Pose> pose;  ///< the newest
  std::optional<protocol::ParameterSet> parameters;
  std::uint64_t parameters_revision = 0;  ///< rises when they were read anew, after each transaction at least
  std::optional<std::string> refusal;     ///< why the newest transaction was refused, if it was
};

class DevicePort {
 public:
  virtual ~DevicePort() = default;
  virtual void send(protocol::Command command) = 0;
  virtual void send(protocol::Command command, const protocol::TestPulse& pulse) = 0;
  /// One transaction. It survives a reconnection, unlike a command.
  virtual void set_parameters(std::vector<device::ParameterChange> changes) = 0;
  /// The scope's signals while the guide wants them; none gives the scope back to whoever had it before.
  virtual void select_signals(std::vector<protocol::Signal> signals) = 0;
};

}  // namespace inkwell::guides
