// An open arm, put together from parts that each own their data. Any thread may call any of them:
//
//   part         its thread                      what it owns
//   PoseFeed     -                               the newest pose, and what was lost: poses, link, force
//   Turns        -                               when the time of virtual boards passes: one for all of a program's own
//   Connection   opens the arm, reads poses,     the device, the board that was started for it, the arm's geometry
//                opens it again after a loss
//   ForceOutput  sends forces                    the newest force, and how it goes with the walls
//   ScopeStream  reads samples                   which signals, samples that are not read yet, the recording
//   Servo        calls the program's function    the function, and whether it is being called
//
// Each part has private mutexes. While a part holds one, it may call PoseFeed but no other part; PoseFeed may then call
// Turns only. In lock step the pose thread does the work of the threads of ForceOutput and ScopeStream.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "connection.hpp"
#include "force_output.hpp"
#include "pose_feed.hpp"
#include "scope_stream.hpp"
#include "servo.hpp"

namespace inkwell::library {

class Arm {
 public:
  explicit Arm(const std::string& address);
  /// Takes the force away first, then waits for a call of the servo that is under way. Not to be called by the servo.
  ~Arm();
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  device::Device& device();  ///< throws Disconnected while no poses come
  const device::Endpoint& endpoint() const { return connection_.endpoint(); }
  Servo& servo() { return servo_; }
  ScopeStream& scope() { return scope_; }

  /// The last pose that came.
  PoseFeed::Seen last() const { return poses_.last(); }
  /// Hands it to `take`, then throws Disconnected if no poses come.
  template <class Take>
  void read(Take take) const {
    poses_.read(take);
  }
  /// The first pose after the one with `sequence`. Throws Disconnected if the link is lost, and TimedOut.
  /// `answer`: a loop that sets a force for each pose is in lock step, too.
  inkwell_pose wait_for_pose(double timeout_s, std::optional<std::uint32_t> after_sequence,
                             Turns::Answer answer = Turns::Answer::none) const;
  /// Waits until this much board time has passed. Throws TimedOut if no poses come.
  void sleep(double duration_s) const;
  control::Pose forward_kinematics(const control::Triple& joint_rad) const;

  /// Drives the arm from now on, as set_force(), place_shapes() and start_servo() do. Throws InUse, naming the driver,
  /// if another program or another arm object of this one drives it.
  void enable_force(double timeout_s);
  /// Takes the arm over from its current driver.
  void take_over();
  void disable_force();
  void stop();
  /// Throws FaultStays if its cause is still there.
  void clear_fault();
  void set_force_mode(protocol::ForceMode mode) { force_.set_mode(mode); }
  void set_force(const double (&force_N)[3]);
  void place_shapes(const device::Shapes& shapes);
  void start_servo(Servo::Function function);

  void set_parameters(const std::vector<device::ParameterChange>& changes);
  void restore_parameters();
  void factory_reset();
  void start_recording(const std::string& path) { scope_.start_recording(path, endpoint().is_virtual); }

  /// Hands the control client of the board that was started for this arm to `action`. Throws NotNow if none was.
  template <class Action>
  void with_own_board(Action action) {
    connection_.with_own_board(action);
  }

 private:
  inkwell_pose pose() const;
  device::Device& linked_device();  ///< throws Disconnected while the link is lost
  void clear_inherited_fault();
  /// The force goes off because this program asks for it, unless the board refuses that.
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
  void claim();
  void drive(const double (&force_N)[3], std::uint32_t pose_sequence);
  void bid_farewell();

  PoseFeed poses_;
  Connection connection_;
  ForceOutput force_;
  ScopeStream scope_;

  std::mutex claim_mutex_;       ///< one thread at a time claims the arm
  std::mutex parameters_mutex_;  ///< one transaction at a time, with what follows from it

  Servo servo_;  ///< the last one: its function uses all the others
};

}  // namespace inkwell::library
