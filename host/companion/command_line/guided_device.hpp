#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host/client/command_line/connection.hpp"
#include "host/client/device/board_timeout.hpp"
#include "host/client/device/session.hpp"
#include "host/client/guides/simulated_user.hpp"

namespace inkwell::command_line {

/// Time limit for a parameter change.
inline device::BoardTimeout transaction_limit() { return {5.0, std::chrono::seconds(5)}; }

/// Connection to the device that a guide uses.
class GuidedDevice {
 public:
  /// Connects to the selected device. With --arm, sets the parameters of the arm description. With --virtual, a
  /// simulated hand performs the user's tasks. Throws device::Error if there is no device.
  explicit GuidedDevice(const DeviceOptions& options);

  device::Session& session() { return *session_; }
  /// Returns the frames received since the last call.
  std::vector<device::ScopeSamples> take_frames();
  void carry_out(const guides::UserTask& task);
  /// Stores the parameters on the board. Throws device::Error with the reason if the board does not store the
  /// parameters.
  void store_parameters();

 private:
  void wait_for_device();
  void apply_parameters(const std::vector<device::ParameterChange>& changes);

  std::unique_ptr<device::VirtualBoard> board_;
  std::optional<guides::SimulatedUser> user_;
  std::mutex mutex_;
  std::vector<device::ScopeSamples> frames_;
  std::unique_ptr<device::Session> session_;  ///< last: its threads use the other members
};

}  // namespace inkwell::command_line
