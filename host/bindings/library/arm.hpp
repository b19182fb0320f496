// Parts of an open arm.
//
//   PoseFeed stores the newest pose, and reports lost poses, links and forces.
//   Turns synchronizes the virtual boards of the program in lock step.
//   Connection connects the arm and reads its poses in a thread.
//   ForceOutput sends the newest force in a thread.
//   ScopeStream reads the samples of the selected signals in a thread.
//   Servo calls the servo function in a thread.
//   Scene computes contacts with objects in the pose thread.
//
// Any thread may call any part. While a part holds its mutex, the part may call only PoseFeed; Scene may also call
// ForceOutput and the device. While PoseFeed holds its mutex, PoseFeed may call only Turns. In lock step, the pose
// thread runs ForceOutput and ScopeStream.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/bindings/library/connection.hpp"
#include "host/bindings/library/force_output.hpp"
#include "host/bindings/library/parameter_watch.hpp"
#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/pose_reports.hpp"
#include "host/bindings/library/scene.hpp"
#include "host/bindings/library/scope_stream.hpp"
#include "host/bindings/library/servo.hpp"

namespace inkwell::library {

class Arm {
 public:
  /// Throws TimedOut if no pose arrives within `timeout_s`.
  Arm(const std::string& address, double timeout_s);
  /// Removes the force, and then waits until a running servo call has returned. The servo must not call this
  /// destructor.
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  device::Device& device();  ///< throws Disconnected while no poses arrive
  const device::Endpoint& endpoint() const { return connection_.endpoint(); }
  Servo& servo() { return servo_; }
  ScopeStream& scope() { return scope_; }

  /// Functions for poses that neither throw nor allocate memory.
  template <class Take, class Refuse>
  inkwell_result read(Take take, Refuse refuse) const {
    return poses_.read(take, refuse);
  }
  /// The newest pose.
  PoseFeed::Seen last() const { return poses_.last(); }
  /// Passes the newest pose to `take`, then throws Disconnected if no poses arrive.
  template <class Take>
  void read(Take take) const {
    poses_.read(take);
  }
  /// Returns the first pose after the pose with this sequence number. Throws Disconnected if the link is lost, and
  /// TimedOut after the time-out. `answer` states whether lock step waits for a force from the calling thread.
  inkwell_pose wait_for_pose(double timeout_s, std::optional<std::uint32_t> after_sequence,
                             Turns::Answer answer = Turns::Answer::none) const;
  /// Waits until this board time has passed. Throws TimedOut if no poses arrive.
  void sleep(double duration_s) const;
  control::Pose forward_kinematics(const control::Triple& joint_rad) const;
  control::Arm geometry() const { return connection_.geometry(); }

  /// Makes this arm object the driver without a force. Throws InUse if another program or arm object drives the arm.
  void claim();
  /// Fades the force, removes the shapes and ends the claim. Throws NotNow if a servo is running.
  void release();
  /// Makes this arm object the driver and switches the force on. Throws InUse with the name of the driver if another
  /// program or arm object drives the arm.
  void enable_force(double timeout_s);
  /// Takes the arm over from its current driver.
  void take_over();
  void disable_force();
  void stop();
  /// Throws FaultStays if the cause of the fault remains.
  void clear_fault();
  void set_force_mode(protocol::ForceMode mode) { force_.set_mode(mode); }
  /// During a loss of poses or force, it returns `refuse(result, sentence)` without exceptions and memory allocation.
  template <class Refuse>
  inkwell_result set_force(const double (&force_N)[3], Refuse refuse) {
    std::uint32_t pose_sequence = 0;
    const inkwell_result result = poses_.check_force(pose_sequence, refuse);
    if (result == INKWELL_OK) drive(force_N, pose_sequence);
    return result;
  }
  /// Sets the scheduling priority of the threads that read poses, send forces and call the servo.
  void set_thread_priority(int priority);
  void place_shapes(const device::Shapes& shapes);
  /// Adds an object to the scene and returns its number. Throws BadArgument, NotNow or an error of the device.
  std::uint32_t add_object(contact::Object object, const contact::Material& material);
  Scene& scene() { return scene_; }
  void start_servo(Servo::Function function);

  void set_parameters(const std::vector<device::ParameterChange>& changes);
  void restore_parameters();
  void factory_reset();
  /// Texts of the next recordings.
  void describe_recordings(std::string name, std::string note);
  void start_recording(const std::string& path);
  recording::RecorderStatus stop_recording();

  struct Losses {
    std::uint64_t poses;  ///< sent by the board and not received
    Servo::Losses servo;
  };
  Losses losses() const { return {reports_.lost(), servo_.losses()}; }
  /// Sends one test pulse to a motor. Throws NotNow if the board is not ready.
  void send_test_pulse(protocol::Command command, const protocol::TestPulse& pulse);

  /// Connects to the control socket of a virtual board that another program has started.
  void connect_control(const std::string& address) { connection_.connect_control(address); }
  /// Passes the control client of the arm's virtual board to `action`. Throws NotNow if this arm has not started a
  /// board.
  template <class Action>
  void with_own_board(Action action) {
    connection_.with_own_board(action);
  }

 private:
  inkwell_pose pose() const;
  device::Device& linked_device();  ///< throws Disconnected while the link is lost
  void clear_inherited_fault();
  /// Calls `action` to switch the force off. The switch-off is not reported as a lost force. If `action` throws, later
  /// losses of the force are reported.
  template <class Action>
  void expecting_force_off(Action action) {
    poses_.expect_force_off();
    try {
      action();
    } catch (...) {
      poses_.forget_lost_force();
      throw;
    }
  }
  /// Changes parameters, and notes the changes in a running recording.
  template <class Change>
  void note_change(Change change);
  /// Notes parameter changes of other programs in a running recording.
  void note_foreign_changes();
  void drive(const double (&force_N)[3], std::uint32_t pose_sequence);
  /// The device has no shapes of this program, and unknown materials.
  void forget_shapes();
  /// Sends parameters and materials to the scene after a new claim. The caller must hold claim_mutex_.
  void prepare_scene();
  bool place_materials(const contact::Scene& scene);
  /// The placed shapes with the rest of their lives.
  device::Shapes living_shapes() const;
  /// Passes changed parameters to the scene.
  void follow_parameters();
  void feel_scene(const device::Pose& report);
  void bid_farewell();

  PoseFeed poses_;
  PoseReports reports_;
  Scene scene_;
  Connection connection_;
  ForceOutput force_;
  ScopeStream scope_;

  std::mutex claim_mutex_;   ///< serializes claims of the arm
  std::mutex shapes_mutex_;  ///< guards the shapes. The materials of the scene replace all shapes of the device.
  device::Shapes placed_shapes_;
  double shapes_placed_at_s_ = 0;  ///< board time
  std::mutex texts_mutex_;         ///< guards the texts of recordings
  std::string recording_name_, recording_note_;
  std::mutex parameters_mutex_;                   ///< serializes transactions and the updates that follow them
  protocol::ParameterSet recorded_parameters_{};  ///< parameters after the last noted change
  /// Not used on a stepped board, because requests at any time would make runs differ.
  ParameterWatch parameter_watch_;

  Servo servo_;  ///< last: its function uses all other members
};

}  // namespace inkwell::library
