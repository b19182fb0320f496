// A thread opens the arm, reads poses, and reopens the arm after a lost link.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "firmware/control/signal_path/kinematics.hpp"
#include "host/client/device/open_arm.hpp"

#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/pose_reader.hpp"
#include "host/bindings/library/pose_reports.hpp"

namespace inkwell::library {

class Connection {
 public:
  /// Called by the thread that reads poses, before the pose is published.
  using OnReport = std::function<void(const device::Pose&)>;
  /// Returns once poses arrive. If the arm has started a virtual board, the constructor also waits for referenced
  /// encoders. Throws TimedOut after `timeout`, and Error.
  Connection(const std::string& address, PoseFeed& poses, PoseReports& reports, Clock::duration timeout,
             OnReport on_report);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Files of a board that this arm has started; empty for other boards.
  const std::filesystem::path& image() const { return arm_.image; }
  const std::filesystem::path& arm_description() const { return arm_.arm_description; }
  /// The reference stays valid after a lost link.
  device::Device& device() const { return *arm_.device; }
  const device::Endpoint& endpoint() const { return arm_.endpoint; }

  /// Passes the board's control client to `action` under a mutex. Throws NotNow if this arm has not started a board.
  template <class Action>
  void with_own_board(Action action) {
    const std::lock_guard lock(control_mutex_);
    action(own_board());
  }

  /// Sets the scheduling priority of the thread that reads poses, as in set_priority().
  void set_thread_priority(int priority) { set_priority(thread_, priority); }
  /// Throws BadAddress, or Error if no board answers.
  void connect_control(const std::string& address);

  control::Arm geometry() const;
  void set_geometry(const protocol::ParameterSet& parameters);

 private:
  void run(const std::string& address, std::promise<void> opened);
  using OnPose = std::function<void(const ReadPose&)>;
  /// Reads poses until the arm closes. Throws when the link is lost.
  void read_poses(const OnPose& on_pose);
  /// Reports the new driver of the arm, or that the arm has no driver. Returns false if the driver is not known yet.
  bool report_lost_claim();
  /// Waits until the arm is connected again, and opens the arm. Returns false if the program closes the arm during the
  /// wait.
  bool reopen();
  bool try_to_reopen();
  std::optional<device::Endpoint> find_again() const;
  bool ends() const;
  void end();
  device::ControlClient& own_board();

  PoseFeed& poses_;
  PoseReports& reports_;
  const OnReport on_report_;
  device::OpenArm arm_;  ///< created and destroyed by the thread; constant between construction and destruction
  std::mutex control_mutex_;
  mutable std::mutex geometry_mutex_;
  control::Arm geometry_{};
  mutable std::mutex end_mutex_;
  std::condition_variable end_changed_;
  bool ends_ = false;
  bool is_open_ = false;  ///< used by the thread
  std::thread thread_;
};

}  // namespace inkwell::library
