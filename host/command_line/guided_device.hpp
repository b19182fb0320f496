// The device that guides run on, kept by a session, with its scope's frames on their way to the guide.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <device/board_timeout.hpp>
#include <device/session.hpp>
#include <guides/simulated_user.hpp>

#include "connection.hpp"

namespace inkwell::command_line {

/// The time that the device has to answer a change of parameters.
inline device::BoardTimeout transaction_limit() { return {5.0, std::chrono::seconds(5)}; }

class GuidedDevice {
 public:
  /// Connects to the device that the options name; with --arm it holds that arm's parameters. With --virtual a
  /// simulated hand does the user's part. Throws device::Error if there is no device.
  explicit GuidedDevice(const DeviceOptions& options);

  device::Session& session() { return *session_; }
  /// Those that came since the last call.
  std::vector<device::ScopeSamples> take_frames();
  void carry_out(const guides::UserTask& task);
  /// Has the board store its parameters. Throws device::Error with its sentence if it does not.
  void store_parameters();

 private:
  void wait_for_device();
  void give_parameters(const std::vector<device::ParameterChange>& changes);

  std::unique_ptr<device::VirtualBoard> board_;
  std::optional<guides::SimulatedUser> user_;
  std::mutex mutex_;
  std::vector<device::ScopeSamples> frames_;
  std::unique_ptr<device::Session> session_;  ///< last: its threads use what is above
};

}  // namespace inkwell::command_line
