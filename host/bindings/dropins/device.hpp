// HDAPI device for one arm.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <inkwell/inkwell.h>

#include "host/bindings/dropins/arm_facts.hpp"
#include "host/bindings/dropins/constants.hpp"
#include "host/bindings/dropins/force_guard.hpp"

namespace inkwell::dropins {

/// Force and torque requests of a program in one frame.
struct Command {
  std::optional<Vector> force_N, joint_torque_mNm;
  std::optional<std::array<double, 6>> motor_values;
  bool has_output() const { return force_N || joint_torque_mNm || motor_values; }
  Vector torque_mNm{}, gimbal_torque_mNm{};  ///< stored only for reading back: the gimbal has no motors
};

/// Pose and requests of a frame.
struct Moment {
  inkwell_pose pose{};
  Vector angular_velocity_rad_per_s{};
  Command command;
};

/// HDAPI capabilities with their initial values.
#define INKWELL_HD_CAPABILITIES(X)                                  \
  X(0x4000, force_output, "HD_FORCE_OUTPUT", false)                 \
  X(0x4001, max_force_clamping, "HD_MAX_FORCE_CLAMPING", true)      \
  X(0x4002, force_ramping, "HD_FORCE_RAMPING", true)                \
  X(0x4003, software_force_limit, "HD_SOFTWARE_FORCE_LIMIT", true)  \
  X(0x4004, one_frame_limit, "HD_ONE_FRAME_LIMIT", true)            \
  X(0x2606, velocity_limit, "HD_SOFTWARE_VELOCITY_LIMIT", true)     \
  X(0x2607, impulse_limit, "HD_SOFTWARE_FORCE_IMPULSE_LIMIT", true) \
  X(0x2900, user_status_light, "HD_USER_STATUS_LIGHT", false)

struct Capabilities {
#define X(value, name, text, at_start) bool name = at_start;
  INKWELL_HD_CAPABILITIES(X)
#undef X
  /// Returns NULL for an unknown capability.
  bool* find(Enum value);
};

struct Settings {
  double velocity_limit_mm_per_s = 1200.0;
  double impulse_limit_N_per_ms = 4.0;
  double ramping_rate_N_per_s = 10.0;
  double status_light = 0.0;
};

/// The caller of a member function must hold Devices::mutex(), unless stated otherwise.
class Device {
 public:
  /// Opens the arm and becomes its driver. Throws std::runtime_error on failure.
  Device(Handle handle, std::string name, const std::string& address);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Handle handle() const { return handle_; }
  const std::string& name() const { return name_; }
  const std::string& address() const { return address_; }
  inkwell_arm* arm() const { return arm_.get(); }
  const ArmFacts& facts() const { return facts_; }
  const inkwell_information& information() const { return information_; }
  double motor_heat(std::size_t motor) const { return motor_heat_[motor]; }
  const Moment& now() const { return now_; }
  const Moment& before() const { return before_; }

  Capabilities capabilities;
  Settings settings;

  /// `tick` is the number of the scheduler tick, or none outside the servo thread.
  void begin_frame(std::optional<std::uint64_t> tick);
  void end_frame();
  bool in_frame() const { return in_frame_; }
  /// The requests of the current frame.
  Command& command() { return now_.command; }

  /// Called when the scheduler starts or stops. The force can be on only while the scheduler runs.
  void set_scheduler_runs(bool runs);
  /// Switches the force on or off as the program requests.
  void follow_force_output();
  /// Returns when the board has confirmed that the force is off, or when the program requests the force again. Raises
  /// COMM_ERROR if the board does not confirm that the force is off. The caller must not hold Devices::mutex().
  void wait_until_force_is_off();
  /// Called after each tick. If the tick had no frame, sends the force of the last frame again.
  void renew_force();

  Calibration calibration();

  /// Whether poses arrive.
  bool sends_poses() const;

 private:
  struct Close {
    void operator()(inkwell_arm* arm) const { inkwell_close(arm); }
  };
  void raise(ErrorCode code, const std::string& sentence = {}, int internal_code = 0) const;
  void claim();
  void poll();
  bool is_inherited(int fault) const;
  void note_condition();
  /// Applies the HDAPI limits to a force, sends the limited force and returns it.
  Vector send(const Command& command, const inkwell_pose& pose);
  std::optional<Vector> demanded_force(const Command& command, const inkwell_pose& pose) const;
  bool wants_force() const { return scheduler_runs_ && capabilities.force_output; }
  /// Thread function for calls that wait for the board.
  void care();

  const Handle handle_;
  const std::string name_, address_;
  std::unique_ptr<inkwell_arm, Close> arm_;
  ArmFacts facts_{};
  inkwell_information information_{};

  Moment now_, before_;
  Command held_;          ///< force requests of the last frame that had any
  bool is_lost_ = false;  ///< no poses arrived at the last check
  bool in_frame_ = false, was_frame_in_tick_ = false;
  std::optional<std::uint64_t> begun_in_tick_;
  ForceGuard guard_;
  ErrorCode dropped_for_ = success;  ///< reason why the last frame's force was dropped
  bool scheduler_runs_ = false;
  bool was_warm_ = false;
  bool is_force_loss_reported_ = false;
  int fault_ = 0;

  std::atomic<double> motor_heat_[3]{};
  std::atomic<bool> had_force_ = false;  ///< since the scheduler started and the link was opened
  std::mutex care_mutex_;
  std::condition_variable care_changed_, off_known_;
  bool ends_ = false, force_is_wanted_ = false, fault_is_to_be_cleared_ = false;
  bool force_is_requested_ = false;  ///< since the last loss
  /// Error text of the last attempt to switch the force off; empty after a success. The text is not set before an
  /// attempt is complete.
  std::optional<std::string> off_problem_;
  std::thread care_thread_;
};

}  // namespace inkwell::dropins
