// The window's side of the device: which one is wanted, and what is known of it in this frame.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <device/session.hpp>

namespace inkwell::window {

/// One frame's view of the device; it does not change while the frame is drawn.
struct DeviceView {
  device::SessionStatus status;
  std::optional<device::Pose> pose;  ///< the newest; none while not connected
  std::optional<protocol::ParameterSet> parameters;
  std::uint64_t parameters_revision = 0;
  std::optional<std::string> refusal;
  std::optional<device::Reconnection> reconnection;  ///< the newest
  std::vector<device::Endpoint> listed;              ///< devices found the last time one looked
  std::string list_error;
  bool must_choose = false;  ///< none of those listed is taken before the user chooses

  bool connected() const { return status.connection == device::Connection::connected; }
  protocol::State state() const { return pose ? pose->state : protocol::State::starting; }
};

class DeviceDesk {
 public:
  DeviceDesk(std::function<std::vector<device::Endpoint>()> list_devices, std::string serial_number);
  ~DeviceDesk();

  /// Call at the start of a frame.
  const DeviceView& refresh();
  const DeviceView& view() const { return view_; }
  device::Session& session() { return *session_; }
  /// As of now, which may be newer than the view; none while not connected.
  std::optional<device::Pose> newest_pose() const { return session_->newest_pose(); }

  /// Asks for another device, or for any with an empty number; follow_choice then connects to it.
  void choose(const std::string& serial_number) { choice_ = serial_number; }
  bool has_choice() const { return choice_.has_value(); }
  /// The session with the present device ends.
  void follow_choice();
  const std::string& wanted_serial_number() const { return wanted_; }
  /// Looks for devices while this is true, for the list that is open.
  void keep_looking(bool looking) { looking_ = looking; }

  /// Signals to be streamed, and where the samples go; kept for the next device too.
  void select_signals(std::vector<protocol::Signal> signals);
  /// What has happened to the devices since the window was opened.
  const device::EventLog& events() const { return events_; }
  /// Frames that came since the last call.
  std::vector<device::ScopeSamples> take_scope();

 private:
  void open_session();
  std::vector<device::Endpoint> look();

  std::function<std::vector<device::Endpoint>()> list_devices_;
  std::string wanted_;
  std::optional<std::string> choice_;
  DeviceView view_;
  device::EventLog events_;
  std::vector<protocol::Signal> signals_;

  std::mutex mutex_;  // of what follows
  std::vector<device::Endpoint> listed_;
  std::string list_error_;
  std::vector<device::ScopeSamples> scope_;

  std::atomic<bool> looking_ = false;
  std::atomic<bool> must_choose_ = false;
  std::unique_ptr<device::Session> session_;
  std::jthread looker_;
};

}  // namespace inkwell::window
