// The thread that opens the arm, reads its poses, and opens it again after its link was lost.
#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <control/kinematics.hpp>
#include <device/open_arm.hpp>

#include "pose_feed.hpp"
#include "pose_reader.hpp"

namespace inkwell::library {

class Connection {
 public:
  /// Returns once poses come; those of a board of its own are valid then. Throws Error.
  Connection(const std::string& address, PoseFeed& poses);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Stays the same object when the link is lost and made again.
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
  using OnPose = std::function<void(const ReadPose&)>;
  /// Until the arm is to be closed. Throws when the link is lost.
  void read_poses(const OnPose& on_pose);
  /// Another program drives the arm now, or none does. False if this is not known yet.
  bool tell_lost_claim();
  /// Waits until the arm is there again, and opens it. False if it is to be closed before.
  bool reopen();
  bool try_to_reopen();
  std::optional<device::Endpoint> find_again() const;
  bool ends() const;
  void end();
  device::ControlClient& own_board();

  PoseFeed& poses_;
  device::OpenArm
      arm_;  ///< made and ended by the thread; constant while the constructor is done and the destructor not
  std::mutex control_mutex_;
  mutable std::mutex geometry_mutex_;
  control::Arm geometry_{};
  mutable std::mutex end_mutex_;
  std::condition_variable end_changed_;
  bool ends_ = false;
  bool is_open_ = false;  ///< of the thread
  std::thread thread_;
};

}  // namespace inkwell::library
