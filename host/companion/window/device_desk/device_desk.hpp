// Access to the chosen device, and the device data for the current frame.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/client/device/session.hpp"

namespace inkwell::window {

/// Snapshot of the device data for one frame.
struct DeviceView {
  device::SessionStatus status;
  std::optional<device::Pose> pose;  ///< newest pose; empty while not connected
  std::optional<protocol::ParameterSet> parameters;
  std::uint64_t parameters_revision = 0;
  std::optional<std::string> refusal;
  std::optional<device::Reconnection> reconnection;  ///< newest reconnection
  std::vector<device::Endpoint> listed;              ///< devices found in the last search
  std::string list_error;
  bool must_choose = false;  ///< the user must choose a device

  bool connected() const { return status.connection == device::Connection::connected; }
  protocol::State state() const { return pose ? pose->state : protocol::State::starting; }
};

/// For Session::on_pose().
using PoseReceiver = std::function<void(device::Device&, const device::DrivenPose&)>;

class DeviceDesk {
 public:
  DeviceDesk(std::function<std::vector<device::Endpoint>()> list_devices, std::string serial_number,
             PoseReceiver receive_pose = {});
  ~DeviceDesk();

  /// Reads the device data. Call at the start of a frame.
  const DeviceView& refresh();
  const DeviceView& view() const { return view_; }
  device::Session& session() { return *session_; }
  /// Returns the current pose, which may be newer than the pose in view(). Empty while not connected.
  std::optional<device::Pose> newest_pose() const { return session_->newest_pose(); }

  /// Requests a device for the next call of follow_choice(). An empty serial number requests any device.
  void choose(const std::string& serial_number) { choice_ = serial_number; }
  bool has_choice() const { return choice_.has_value(); }
  /// Disconnects the current device and connects to the chosen device.
  void follow_choice();
  const std::string& wanted_serial_number() const { return wanted_; }
  /// Searches for devices continuously while `searching` is true.
  void keep_searching(bool searching) { is_searching_ = searching; }

  /// Selects the streamed signals for the current device and all later devices.
  void select_signals(std::vector<protocol::Signal> signals);
  /// Returns all device events since the window was opened.
  const device::EventLog& events() const { return events_; }
  /// Adds a mark of the user at the time of the newest pose.
  void mark(const std::string& text);
  /// Returns the scope frames that arrived since the last call.
  std::vector<device::ScopeSamples> take_scope();

 private:
  void open_session();
  std::vector<device::Endpoint> find_endpoints();

  std::function<std::vector<device::Endpoint>()> list_devices_;
  PoseReceiver receive_pose_;
  std::string wanted_;
  std::optional<std::string> choice_;
  DeviceView view_;
  device::EventLog events_;
  std::vector<protocol::Signal> signals_;

  std::mutex mutex_;  // protects the members below
  std::vector<device::Endpoint> listed_;
  std::string list_error_;
  std::vector<device::ScopeSamples> scope_;

  std::atomic<bool> is_searching_ = false;
  std::atomic<bool> must_choose_ = false;
  std::unique_ptr<device::Session> session_;
  std::jthread searcher_;
};

}  // namespace inkwell::window
