// An open arm: three threads that read poses, call the servo and send forces, so that no caller waits for the USB.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <inkwell/inkwell.h>
#include <control/kinematics.hpp>
#include <device/driver_claim.hpp>
#include <device/open_arm.hpp>
#include <kinematics/velocity.hpp>
#include <recording/recorder.hpp>

namespace inkwell::library {

using device::Error;

/// What was waited for did not come.
class TimedOut : public Error {
 public:
  using Error::Error;
};
/// A value that the function can not take.
class BadArgument : public Error {
 public:
  using Error::Error;
};
/// The device does not take it, or not now.
class NotNow : public Error {
 public:
  using Error::Error;
};

/// What the address of inkwell_open() stands for; what INKWELL_DEVICE says if it is empty.
device::OpenArm open_arm(const std::string& address);
/// Everything that open_arm() can find, with the address that leads there.
std::vector<inkwell_device> list_devices();

/// A pose with what follows from it.
class PoseReader {
 public:
  explicit PoseReader(const protocol::ParameterSet& parameters);
  inkwell_pose read(const protocol::PoseReport& report);
  control::Pose forward_kinematics(const control::Triple& joint_rad) const;

 private:
  control::Arm arm_;
  kinematics::VelocityFit velocity_;
  std::uint64_t periods_ = 0;  ///< since the board started, beyond the wrap of the report's counter
};

class Arm {
 public:
  using Servo = std::function<bool(const inkwell_pose& pose, double (&force_N)[3])>;

  explicit Arm(const std::string& address);
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  device::Device& device();  ///< throws Disconnected once it is gone
  const device::Endpoint& endpoint() const { return endpoint_; }
  device::ControlClient& virtual_hand();  ///< throws NotNow if the board is not this arm's own

  inkwell_pose pose() const;
  /// The first pose after the one with `sequence`.
  inkwell_pose wait_for_pose(double timeout_s, std::optional<std::uint32_t> after_sequence);

  control::Pose forward_kinematics(const control::Triple& joint_rad) const;

  void enable_force(double timeout_s);
  void disable_force();
  void set_force_mode(protocol::ForceMode mode);
  void set_force(const double (&force_N)[3]);
  void place_shapes(const device::Shapes& shapes);
  void start_servo(Servo servo);
  void stop_servo();
  bool servo_is_running() const;

  void set_parameters(const std::vector<device::ParameterChange>& changes);

  void select_signals(const std::vector<protocol::Signal>& signals);
  /// At most `capacity` samples of those that came; none on time-out.
  std::optional<device::ScopeSamples> read_scope(double timeout_s, std::size_t capacity);
  void start_recording(const std::string& path);
  recording::RecorderStatus stop_recording();

 private:
  struct Published {
    inkwell_pose pose{};
    bool valid = false;
  };

  void open(const std::string& address);
  void report_loop(std::promise<void> opened);
  void output_loop();
  void servo_loop(Servo servo);
  void scope_loop();
  void lose(const std::string& reason);
  void claim();
  void require_connected(const std::unique_lock<std::mutex>& lock) const;

  std::unique_ptr<device::VirtualBoard> board_;  ///< made and ended by the report thread
  std::optional<device::ControlClient> control_;
  std::unique_ptr<device::Device> device_;
  device::Endpoint endpoint_{};

  mutable std::mutex mutex_;
  std::condition_variable pose_changed_, force_changed_, servo_changed_, scope_changed_;
  bool stopping_ = false;
  std::optional<std::string> lost_;  ///< why the device is gone
  Published newest_;
  std::optional<PoseReader> reader_;

  std::optional<device::ForceRequest> next_force_;
  protocol::ForceMode mode_ = protocol::ForceMode::instead_of_walls;
  std::optional<device::DriverClaim> claim_;  ///< from the first force on
  bool servo_runs_ = false, servo_ends_ = false;
  std::thread::id servo_thread_id_;

  std::vector<protocol::Signal> signals_;
  std::vector<device::ScopeSamples> samples_;  ///< not read yet
  std::size_t rows_kept_ = 0;
  std::unique_ptr<recording::Recorder> recorder_;

  std::thread report_thread_, output_thread_, servo_thread_, scope_thread_;
};

}  // namespace inkwell::library
