// A virtual board with its arm, a hand, a host and a judge: what the phases are made of.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include <campaign/board_run.hpp>
#include <campaign/cases.hpp>
#include <soak/oracle.hpp>
#include <soak/result.hpp>
#include <soak/run.hpp>
#include <soak/storm.hpp>

namespace inkwell::soak {

/// The board does not do what it was asked for, so that the phase makes no sense any more. Told already.
struct PhaseFailed : device::Error {
  using Error::Error;
};

/// The sitting is over in the middle of a phase. No error, so that nothing on the way takes it for one of the board's.
struct SittingOver {};

class Bench {
 public:
  Bench(unsigned number, const Choices& choices, const device::VirtualBoardOptions& board);

  // ---- time, looked at all along
  /// Lets board time pass with the host's signs of life or without.
  /// Throws SittingOver at the end of the sitting.
  void pass(double time_s, bool gives_sign_of_life = true);
  /// What the simulation knows at this instant.
  void look();
  /// What is read rarely: restarts, broken rules, whether the processor is locked up.
  void look_closely();
  /// The same, and whether the board still answers and holds what it accepted.
  void check_all();

  // ---- what a user does
  /// Connected, no fault, referenced, force off, the hand holding the stylus in free space.
  void make_ready();
  void make_active();
  void give_up_force();
  void dock();
  void take_out();
  void connect(double limit_s = 1.0);
  /// Clears the fault, switches the force on.
  void go_on();
  void reset();
  /// From where it pulls to now.
  void move_hand(device::Vector3 to_m, double duration_s);
  device::Vector3 free_point_m();
  device::Vector3 wall_point_m(double force_N);
  /// Random buttons, angles of the stylus, questions.
  void fidget();

  // ---- parameters
  void set(std::span<const device::ParameterChange> changes);
  void set(device::ParameterChange change) { set(std::span(&change, 1)); }
  /// Sends what must be refused.
  void try_illegal();
  void restore_defaults();
  void check_parameters();
  /// What the board holds now, as after it started anew.
  void hold(const protocol::ParameterSet& set);

  [[noreturn]] void fail(Complaint complaint, const std::string& text);

  Random random;
  campaign::BoardRun board;
  Oracle oracle;
  Sitting sitting;
  const Choices choices;
  protocol::ParameterSet defaults{}, accepted{};
  protocol::ParameterSet stored{};  ///< what a start gives
  /// Asked all along; none while the board starts, which a sitting does in any case.
  std::function<bool()> is_over;
  /// The cable is out, or the program is killed.
  bool device_may_go = false;
  bool is_sound() const { return disturbance_ == Disturbance::none; }
  /// What is put in, or none any more.
  void disturb(Disturbance disturbance);

 private:
  void limit_changes(float force_limit_N);
  void check_pose();

  Disturbance disturbance_ = Disturbance::none;
  double until_close_look_s_ = 0;
};

/// Lets the phase of this kind happen; what was done, in words.
std::string play(Bench& bench, Kind kind);

// In uses.cpp, storms.cpp, stores.cpp and adversities.cpp:
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
