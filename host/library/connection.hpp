// The thread that opens the arm and reads its poses.
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <thread>

#include <control/kinematics.hpp>
#include <device/open_arm.hpp>

#include "pose_feed.hpp"

namespace inkwell::library {

class Connection {
 public:
  /// Returns once poses come; those of a board of its own are valid then. Throws Error.
  Connection(const std::string& address, PoseFeed& poses);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Stays when the link is lost, so that who is calling it meanwhile hears so from it.
  device::Device& device() const { return *arm_.device; }
  const device::Endpoint& endpoint() const { return arm_.endpoint; }

  /// Hands the board's control client to `action`, to one at a time. Throws NotNow if the board is not this arm's own.
  template <class Action>
  void with_own_board(Action action) {
    const std::lock_guard lock(control_mutex_);
    action(own_board());
  }

  control::Arm geometry() const;
  void set_geometry(const protocol::ParameterSet& parameters);

 private:
  void run(const std::string& address, std::promise<void> opened);
  void read_poses(std::promise<void>& opened, bool& is_open);
  device::ControlClient& own_board();

  PoseFeed& poses_;
  device::OpenArm
      arm_;  ///< made and ended by the thread; constant while the constructor is done and the destructor not
  std::mutex control_mutex_;
  mutable std::mutex geometry_mutex_;
  control::Arm geometry_{};
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace inkwell::library
