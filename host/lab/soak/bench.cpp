#include "host/lab/soak/bench.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/lab/campaign/handling.hpp"
#include "host/lab/experiment/wall.hpp"

namespace inkwell::soak {
namespace {

using device::Vector3;
using protocol::Command;
using protocol::Parameter;
using protocol::State;

constexpr double poll_interval_s = 0.005;
constexpr double close_check_s = 0.1;

/// The first reset is the watchdog test and not a restart.
unsigned restarts_of(const nlohmann::json& answer) { return std::max(answer.at("resets").get<unsigned>(), 1u) - 1; }

bool force_on(const device::Pose& pose) { return protocol::force_is_on(pose.state); }

}  // namespace

Bench::Bench(unsigned number, const Choices& choices_, const device::VirtualBoardOptions& options)
    : random(choices_.seed, number), board(options), choices(choices_) {
  sitting.number = number;
  board.watch_poses([this](const auto& pose) { oracle.see(pose); });
  board.control().meter_start();
  connect();
  defaults = accepted = stored = board.device().parameters();
  oracle.limit_force(static_cast<double>(defaults[Parameter::force_limit_N]));
}

void Bench::fail(Complaint complaint, const std::string& text) {
  oracle.complain(complaint, text);
  throw PhaseFailed(text);
}

// ---- time ----------------------------------------------------------------------------------------------------

void Bench::pass(double time_s, bool sends_heartbeats) {
  double left_s = time_s;
  while (left_s > 1e-9) {
    const bool was_connected = board.connected();
    const double step_s = std::min(left_s, poll_interval_s);
    left_s -= poll_interval_s;
    board.run(step_s, sends_heartbeats);
    check_truth();
    until_close_check_s_ -= step_s;
    if (until_close_check_s_ <= 0) check_closely();
    if (is_over && is_over()) throw SittingOver();
    if (was_connected && !board.connected() && is_undisturbed() && !device_may_go)
      fail(Complaint::no_answer, "the device was disconnected");
  }
}

void Bench::check_truth() {
  const auto truth = board.control().truth();
  const auto reading = board.control().meter_read();
  board.control().meter_start();
  oracle.see(Snapshot{truth.at("board_time_s"), truth.at("bridges_driven_until_s"), restarts_of(truth),
                      reading.peak_motor_force_N, reading.peak_motor_force_over_ms_N});
}

void Bench::check_closely() {
  until_close_check_s_ = close_check_s;
  const auto status = board.control().status().all;
  unsigned long broken_rules = 0;
  std::string rule;
  for (const auto& violation : status.at("violations")) {
    broken_rules += violation.at("count").get<unsigned long>();
    rule = fmt::format("{} {}", violation.value("sentence", ""), violation.value("code", ""));
  }
  if (oracle.see_counts(restarts_of(status), broken_rules, rule)) hold(stored);
  if (is_undisturbed() && status.contains("locked_up")) fail(Complaint::no_answer, "the processor is locked up");
}

/// Compares the newest pose with the slightly newer `truth`.
void Bench::check_pose() {
  if (!board.pose() || !board.pose()->is_referenced) return;
  const auto truth = board.control().truth();
  double squares_m2 = 0, squares_m2_per_s2 = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, experiment::axis_letter(static_cast<int>(axis)));
    const double true_m = truth.at("true_position_" + letter + "_m");
    squares_m2 += std::pow(static_cast<double>(board.pose()->position_m[axis]) - true_m, 2);
    squares_m2_per_s2 += std::pow(truth.at("true_velocity_" + letter + "_m_s").get<double>(), 2);
  }
  constexpr double allowed_m = 0.001, age_s = 0.003;
  const double error_m = std::sqrt(squares_m2);
  if (error_m > allowed_m + age_s * std::sqrt(squares_m2_per_s2))
    oracle.complain(Complaint::wrong_pose, fmt::format("the true position differs by {:.1f} mm", 1e3 * error_m));
}

void Bench::disturb(Disturbance disturbance) {
  disturbance_ = disturbance;
  oracle.disturb(disturbance);
}

void Bench::check_all() {
  check_closely();
  if (!board.connected()) fail(Complaint::no_answer, "there is no device at the end of the phase");
  if (board.is(State::fault)) throw PhaseFailed("a fault was reported");  // the next phase must start without a fault
  pass(poll_interval_s);
  check_pose();
  check_parameters();
}

// ---- parameters ----------------------------------------------------------------------------------------------

/// A lower limit applies immediately, but the currents need time to decrease.
void Bench::limit_changes(float force_limit_N) {
  const auto limit_N = static_cast<double>(force_limit_N);
  if (limit_N == oracle.force_limit_N()) return;
  if (limit_N < oracle.force_limit_N()) {
    board.run(poll_interval_s);
    check_truth();
  }
  oracle.limit_force(limit_N);
}

void Bench::set(std::span<const device::ParameterChange> changes) {
  ++sitting.transactions;
  try {
    const float limit_N = with(accepted, changes)[Parameter::force_limit_N];
    if (static_cast<double>(limit_N) > oracle.force_limit_N()) limit_changes(limit_N);
    board.device().set_parameters(changes);
  } catch (const device::Refused& refused) {
    fail(Complaint::wrong_answer, fmt::format("a legal transaction was refused: {}", refused.what()));
  }
  accepted = with(accepted, changes);
  limit_changes(accepted[Parameter::force_limit_N]);
}

void Bench::try_illegal() {
  ++sitting.transactions;
  const bool active = board.force_is_on();
  const Illegal illegal = illegal_changes(random, accepted, active);
  try {
    board.device().set_parameters(illegal.changes);
  } catch (const device::Refused& refused) {
    ++sitting.refused_transactions;
    if (refused.report.refusal != illegal.refusal)
      fail(Complaint::wrong_answer,
           fmt::format("the reason for the refusal is {} instead of {}", protocol::info(refused.report.refusal).name,
                       protocol::info(illegal.refusal).name));
    return;
  }
  fail(Complaint::wrong_answer,
       fmt::format("a transaction was accepted although it is {}", protocol::info(illegal.refusal).name));
}

void Bench::restore_defaults() {
  ++sitting.transactions;
  board.device().restore_default_parameters();
  accepted = defaults;
  limit_changes(accepted[Parameter::force_limit_N]);
}

void Bench::check_parameters() {
  const auto held = board.device().parameters();
  if (held == accepted) return;
  const auto rows = protocol::known_parameters();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (held.values[i] != accepted.values[i])
      fail(Complaint::wrong_parameters,
           fmt::format("{} is {}, but {} was accepted last", rows[i].name, held.values[i], accepted.values[i]));
}

void Bench::hold(const protocol::ParameterSet& set) {
  accepted = set;
  oracle.limit_force(static_cast<double>(accepted[Parameter::force_limit_N]));
}

// ---- user actions --------------------------------------------------------------------------------------------

void Bench::connect(double limit_s) {
  oracle.connected();
  if (!board.connect(limit_s)) fail(Complaint::no_answer, "the device did not reconnect");
  pass(2 * poll_interval_s);
}

Vector3 Bench::free_point_m() {
  constexpr double margin_m = 0.02;
  Vector3 point_m{};
  for (int axis = 0; axis < 3; ++axis)
    point_m[static_cast<std::size_t>(axis)] = random.from(experiment::wall_position_m(defaults, {axis, -1}) + margin_m,
                                                          experiment::wall_position_m(defaults, {axis, 1}) - margin_m);
  return point_m;
}

Vector3 Bench::wall_point_m(double force_N) {
  const experiment::BoxWall wall{static_cast<int>(random.below(3)), random.chance(0.5) ? 1 : -1};
  Vector3 point_m = free_point_m();
  const auto axis = static_cast<std::size_t>(wall.axis);
  point_m[axis] = campaign::into_wall_m(defaults, wall, force_N)[axis];
  return point_m;
}

void Bench::move_hand(Vector3 to_m, double duration_s) { board.control().hand_path({{duration_s, to_m}}); }

void Bench::take_out() {
  campaign::take_by_hand(board, free_point_m(), 0.5);
  pass(0.6);
}

void Bench::dock() {
  // The arm is referenced again after a rest in the inkwell. The board reports lost counts some milliseconds after the
  // inkwell switch has closed.
  constexpr double longest_s = 2.3, close_check_interval_s = 0.02, rest_s = 0.3;
  board.control().dock(true);
  double rested_s = 0;
  double waited_s = 0;
  while (waited_s < longest_s) {
    pass(close_check_interval_s);
    waited_s += close_check_interval_s;
    // The board detects lost counts only in the inkwell. The oracle decides whether lost counts are allowed.
    if (board.is(State::fault)) {
      rested_s = 0;
      const protocol::Fault reported_fault = board.pose()->fault;
      if (!(lost_counts & protocol::condition(reported_fault)).any()) continue;
      board.command(Command::clear_fault);
      // This fault is cleared only after the inkwell switch has opened.
      if (reported_fault == protocol::Fault::inkwell_implausible) {
        board.control().dock(false);
        pass(close_check_interval_s);
        board.control().dock(true);
      }
    }
    const bool rests = board.is(State::ready) && board.control().truth().at("inkwell_switch").get<bool>();
    rested_s = rests ? rested_s + close_check_interval_s : 0.0;
    if (rested_s >= rest_s) return;
  }
  fail(Complaint::no_answer, "the board did not find its reference in the inkwell");
}

void Bench::withdraw_force() {
  const auto landing_s = static_cast<double>(accepted[Parameter::soft_landing_s]);
  board.command(Command::disable_force);
  oracle.withdraw_force(landing_s);
  pass(landing_s + 0.03);
}

void Bench::make_ready() {
  if (!board.connected()) connect();
  if (board.is(State::fault))
    fail(Complaint::no_answer,
         fmt::format("the previous phase left the fault {}", protocol::info(board.pose()->fault).name));
  if (board.force_is_on()) withdraw_force();
  if (board.is(State::starting) || board.is(State::testing)) pass(0.3);
  if (board.is(State::unreferenced)) dock();
  const auto truth = board.control().truth();
  if (!truth.at("hand_holds").get<bool>() || truth.at("inkwell_switch").get<bool>()) take_out();
  if (!board.is(State::ready)) fail(Complaint::no_answer, "the board is not ready");
}

void Bench::make_active() {
  if (!board.connected() || !board.force_is_on()) {
    make_ready();
    oracle.request_force();
    board.command(Command::enable_force);
    for (double waited_s = 0; waited_s < 0.1 && !(board.pose() && force_on(*board.pose())); waited_s += poll_interval_s)
      pass(poll_interval_s);
    if (!board.force_is_on()) fail(Complaint::no_answer, "the force did not switch on");
  }
  pass(random.chance(0.5) ? static_cast<double>(accepted[Parameter::force_ramp_s]) : 0.02);
}

void Bench::go_on() {
  if (!board.connected()) connect();
  if (board.is(State::fault)) {
    board.command(Command::clear_fault);
    pass(0.05);
    if (board.is(State::fault))
      fail(Complaint::no_way_back, fmt::format("{} cannot be cleared", protocol::info(board.pose()->fault).name));
  }
  oracle.allow_no_fault();
  make_active();
}

void Bench::reset() {
  oracle.expect_restart();
  oracle.withdraw_force(0.0);
  board.reset();
  check_closely();
  board.control().hand({});
  connect();
}

void Bench::fidget() {
  if (random.chance(0.03)) board.control().buttons(random.chance(0.5), random.chance(0.5));
  if (random.chance(0.03)) board.control().gimbal({random.from(-2, 2), random.from(-0.4, 1.5), random.from(-2, 2)});
  if (random.chance(0.01)) board.device().information();
  if (random.chance(0.01)) board.device().bus_frame();
  if (random.chance(0.01)) check_parameters();
}

}  // namespace inkwell::soak
