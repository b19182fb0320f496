// Test environment of the phases.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/cases.hpp"
#include "host/lab/soak/oracle.hpp"
#include "host/lab/soak/result.hpp"
#include "host/lab/soak/run.hpp"
#include "host/lab/soak/storm.hpp"

namespace inkwell::soak {

/// The phase cannot continue. The finding is already recorded.
struct PhaseFailed : device::Error {
  using Error::Error;
};

/// Thrown at the end of the sitting. Handlers of device::Error do not catch this type.
struct SittingOver {};

class Bench {
 public:
  Bench(unsigned number, const Choices& choices, const device::VirtualBoardOptions& board);

  // ---- time

  /// Advances board time. Throws SittingOver at the end of the sitting.
  void pass(double time_s, bool sends_heartbeats = true);
  /// Checks `truth` of the control socket.
  void check_truth();
  /// Checks for restarts, violated rules, and a lock-up of the processor.
  void check_closely();
  /// Calls check_closely(), then checks the pose and the parameters.
  void check_all();

  // ---- user actions

  /// Afterwards the device is connected and referenced without a fault, the force is off, and the hand holds the
  /// stylus.
  void make_ready();
  void make_active();
  void withdraw_force();
  void dock();
  void take_out();
  void connect(double limit_s = 1.0);
  /// Clears the fault and switches the force on.
  void go_on();
  void reset();
  /// The motion starts at the present target of the hand.
  void move_hand(device::Vector3 to_m, double duration_s);
  device::Vector3 free_point_m();
  device::Vector3 wall_point_m(double force_N);
  /// Simulates random buttons, stylus angles and queries.
  void fidget();

  // ---- parameters
  void set(std::span<const device::ParameterChange> changes);
  void set(device::ParameterChange change) { set(std::span(&change, 1)); }
  void try_illegal();
  void restore_defaults();
  void check_parameters();
  /// Sets the expected parameters of the board.
  void hold(const protocol::ParameterSet& set);

  [[noreturn]] void fail(Complaint complaint, const std::string& text);

  Random random;
  campaign::BoardRun board;
  Oracle oracle;
  Sitting sitting;
  const Choices choices;
  protocol::ParameterSet defaults{}, accepted{};
  protocol::ParameterSet stored{};  ///< values after a restart
  /// Stop condition, polled continuously. The member is empty while the board starts, so that every sitting completes
  /// the start.
  std::function<bool()> is_over;
  /// True while a disconnection is expected.
  bool device_may_go = false;
  bool is_undisturbed() const { return disturbance_ == Disturbance::none; }
  /// Sets the active disturbance.
  void disturb(Disturbance disturbance);

 private:
  void limit_changes(float force_limit_N);
  void check_pose();

  Disturbance disturbance_ = Disturbance::none;
  double until_close_check_s_ = 0;
};

/// Runs a phase of this kind. Returns a description of the phase.
std::string play(Bench& bench, Kind kind);

// The functions below are defined in uses.cpp, storms.cpp, stores.cpp and adversities.cpp.
std::string use_docking(Bench& bench);
std::string use_free_space(Bench& bench, double time_s);
std::string use_walls(Bench& bench, double time_s);
std::string use_fast(Bench& bench, double time_s);
std::string use_program(Bench& bench, double time_s);
std::string use_scope(Bench& bench, double time_s);
std::string use_recording(Bench& bench, double time_s);
std::string live_storm(Bench& bench, double time_s);
std::string wide_storm(Bench& bench, double time_s);
std::string store_parameters(Bench& bench);
std::string pull_cable(Bench& bench);
std::string be_silent(Bench& bench);
std::string kill_program(Bench& bench);
std::string reset_board(Bench& bench);
std::string be_too_fast(Bench& bench);
std::string put_fault_in(Bench& bench);

}  // namespace inkwell::soak
