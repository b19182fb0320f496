#include "host/lab/campaign/run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <utility>

#include "host/client/local/private_folder.hpp"
#include "host/lab/campaign/board_run.hpp"
#include "host/lab/campaign/handling.hpp"
#include "host/lab/campaign/model_faults.hpp"
#include "protocol/reports.hpp"

#include "host/lab/campaign/use.hpp"

namespace inkwell::campaign {
namespace {

using device::Vector3;
using protocol::Command;
using protocol::InjectedFault;
using protocol::Parameter;
using protocol::ParameterSet;
using protocol::State;

constexpr double push_part_of_limit = 0.75;  // fraction of the force limit
constexpr double longest_case_s = 60;        // board time
constexpr double more_than_limit = 1.2;      // force of the hand as a multiple of the force limit

/// Fault reported before the injection.
constexpr auto first_fault = protocol::Fault::host_silent;

struct NotReached : device::Error {
  using Error::Error;
};

void expect(bool reached, const char* what) {
  if (!reached) throw NotReached(std::string("The case could not begin: ") + what);
}

bool is_about_the_host(const CaseFault& fault) {
  return fault.fault == InjectedFault::usb_cut || fault.fault == InjectedFault::host_silent ||
         fault.deed == Deed::bus_suspended;
}

bool is_before_power(const Case& the_case) {
  return the_case.situation == CaseSituation::starting && the_case.phase == 1;
}

void set_to_maximum(BoardRun& board, ParameterSet& parameters, Parameter parameter) {
  const float maximum = protocol::info(parameter).maximum;
  board.set({{parameter, maximum}});
  parameters[parameter] = maximum;
}

/// Starts the self-test and waits for its first pulse.
void begin_self_test(BoardRun& board) {
  constexpr double poll_interval_s = 0.0005, longest_s = 0.05;
  board.command(Command::self_test);
  bool has_begun = false;
  for (double waited_s = 0; !has_begun && waited_s < longest_s; waited_s += poll_interval_s) {
    board.run_exactly(poll_interval_s);
    has_begun = bridges_drive(board.control().truth());
  }
  expect(has_begun, "the self-test made no pulse.");
}

/// Requires that the arm is in the middle of the box and the force is off.
void switch_force_on(BoardRun& board, ParameterSet& parameters, CaseSituation situation) {
  if (is_pressed(situation)) set_to_maximum(board, parameters, Parameter::wall_stiffness_N_per_m);
  if (situation == CaseSituation::ramping) set_to_maximum(board, parameters, Parameter::force_ramp_s);
  if (situation == CaseSituation::landing) set_to_maximum(board, parameters, Parameter::soft_landing_s);
  board.command(Command::enable_force);
  expect(board.wait_for([](const auto& pose) { return protocol::force_is_on(pose.state); }, 0.5),
         "the force did not go on.");
  if (situation != CaseSituation::ramping) board.run(static_cast<double>(parameters[Parameter::force_ramp_s]) + 0.05);
}

/// Returns true if the state of the board matches the situation.
bool is_there(const BoardRun& board, CaseSituation situation) {
  switch (situation) {
    case CaseSituation::ramping: return board.is(State::ramping);
    case CaseSituation::limited: return board.is(State::limited);
    case CaseSituation::landing: return board.is(State::landing);
    default: return board.force_is_on();
  }
}

/// Causes `first_fault`: the host sends no heartbeats while the force is on.
void bring_a_first_fault(BoardRun& board) {
  constexpr double silent_s = 0.1, brakes_s = 0.05;  // brakes_s is short because the arm was at rest
  board.run(silent_s, false);
  expect(board.is(State::fault) && board.pose()->fault == first_fault, "the board did not miss its host.");
  board.run(brakes_s);
}

/// Starts the update. Before the boot loader starts, the board writes all parameters, because none were stored.
void begin_update(BoardRun& board) {
  constexpr double report_delay_s = 0.002;
  board.command(Command::store_parameters);
  board.run(report_delay_s);
  board.request_boot_loader();
  expect(board.wait_for(State::update, 0.02), "the board did not leave for its boot loader.");
}

/// Writes a flash file of a board whose motors are confirmed, because only such a board tests its motors for faults.
void write_confirmed_board(device::VirtualBoardOptions options, const std::filesystem::path& flash) {
  constexpr double storing_s = 0.3;
  options.flash = flash;
  BoardRun board(options);
  expect(board.connect(1.0), "the device did not enumerate.");
  board.set({{Parameter::motors_confirmed, 1.0f}});
  board.command(Command::store_parameters);
  board.run(storing_s);
}

/// The hand grips the stylus before the board starts. After power-on the watchdog expires once.
void begin_start(BoardRun& board, const Case& the_case) {
  take_by_hand(board, board.true_position_m(), 0.05);
  if (is_before_power(the_case)) return;
  constexpr double poll_interval_s = 0.0005, longest_s = 0.1;
  for (double waited_s = 0; board.resets() < 1 && waited_s < longest_s; waited_s += poll_interval_s)
    board.run_exactly(poll_interval_s);
  expect(board.resets() == 1, "the board did not start.");
}

/// Brings the board into the situation and returns its parameters.
ParameterSet bring_into(BoardRun& board, const Case& the_case) {
  const CaseSituation situation = the_case.situation;
  // The stylus leaves the inkwell before the board starts, so the board has no reference.
  if (situation == CaseSituation::unreferenced) {
    Vector3 away_m = board.true_position_m();
    away_m[2] -= 0.04;
    take_by_hand(board, away_m, 0.05);
  }
  if (situation == CaseSituation::starting) {
    begin_start(board, the_case);
    return protocol::default_parameters();
  }
  expect(board.connect(1.0), "the device did not enumerate.");
  ParameterSet parameters = board.device().parameters();
  // The long host time-out prevents a time-out fault, because this host is silent after each injection. Cases with
  // host faults, and cases in the situation `fault`, use the default time-out.
  if (!is_about_the_host(the_case.fault) && situation != CaseSituation::fault)
    board.set({{Parameter::host_timeout_s, 2.0f}});
  if (situation == CaseSituation::unreferenced) {
    expect(board.wait_for(State::unreferenced, 1.0), "the board knew where the arm is.");
    board.run(0.3);
    return parameters;
  }
  expect(board.wait_for(State::ready, 1.0), "the board did not find its reference.");
  take_by_hand(board, middle_of_box_m(parameters), 0.4);
  board.run(0.6);
  if (situation == CaseSituation::ready) return parameters;
  if (situation == CaseSituation::testing) {
    board.set({{Parameter::motors_confirmed, 1.0f}});
    begin_self_test(board);
    return parameters;
  }
  if (situation == CaseSituation::update) {
    begin_update(board);
    return parameters;
  }
  switch_force_on(board, parameters, situation);
  if (situation == CaseSituation::fault) {
    bring_a_first_fault(board);
    return parameters;
  }
  const Vector3 middle_m = middle_of_box_m(parameters);
  if (is_pressed(situation)) {
    const double part_of_limit = situation == CaseSituation::limited ? more_than_limit : push_part_of_limit;
    board.control().hand_path({{0.0, middle_m}, {0.3, beyond_forward_wall_m(parameters, part_of_limit)}});
    board.run(0.45);
  }
  if (situation == CaseSituation::landing) {
    board.command(Command::disable_force);
    board.run(0.05);
  }
  if (situation == CaseSituation::motion) {
    std::vector<device::HandWaypoint> path = swings(middle_m, 12);
    path.insert(path.begin(), {0.0, middle_m});
    board.control().hand_path(path);
    board.run(0.3);
  }
  expect(is_there(board, situation), "the force is not what the situation asks for.");
  return parameters;
}

double longest_phase_of(CaseSituation situation) {
  switch (situation) {
    // The pulses of each motor last 4 ms, so the instant is during the pulses of motor 1.
    case CaseSituation::testing: return 0.004;
    case CaseSituation::update: return 0.05;  // the board writes its parameters for a longer time
    case CaseSituation::ramping: return 1.0;
    case CaseSituation::starting: return 0.43;  // one of the two phases is during the motor test
    default: return 0.1;
  }
}

/// Instant of a phase. The instant does not depend on the fault, so results are comparable with the control case.
double phase_s(const Case& the_case) {
  if (is_before_power(the_case)) return 0;
  const double longest_phase_s = longest_phase_of(the_case.situation);
  std::mt19937 random(100 * static_cast<unsigned>(the_case.situation) + the_case.phase);
  return longest_phase_s * static_cast<double>(random() >> 8) / static_cast<double>(1u << 24);
}

void put_in(BoardRun& board, const CaseFault& what, const ParameterSet& parameters, Result& result) {
  auto& control = board.control();
  if (what.deed == Deed::fast_hand) control.hand_path(fling(middle_of_box_m(parameters)));
  if (what.deed == Deed::bus_suspended) board.drop_device();
  if (!what.fault) return;
  control.inject({std::string(protocol::info(*what.fault).name), what.of, what.amount, 0.0, what.for_s});
  const auto injected = control.truth().at("injected");
  if (what.of.empty() && !injected.empty()) result.location = injected[0].value("of", "");
}

/// At start-up the watchdog expires once. The board also resets before it enters the boot loader.
unsigned resets_meant(const BoardRun& board, const Case& the_case) {
  const bool has_left = the_case.situation == CaseSituation::update && board.is_in_boot_loader();
  return is_before_power(the_case) || has_left ? 1 : 0;
}

void observe(BoardRun& board, const Case& the_case, const ParameterSet& parameters, Result& result) {
  auto& control = board.control();
  const auto before = control.truth();
  const unsigned resets_before = board.resets();
  result.injected_at_s = before.at("board_time_s");
  result.bridges_were_on = !is_before_power(the_case) && bridges_drive(before);
  put_in(board, the_case.fault, parameters, result);
  control.meter_start();
  if (is_about_models(the_case.fault.deed))
    run_with_models(board, the_case.fault.deed, observed_s);
  else
    board.run(observed_s, false);

  const auto after = control.truth();
  const auto reading = control.meter_read();
  const double driven_until_s = after.at("bridges_driven_until_s");
  const bool drive = bridges_drive(after);
  if (result.bridges_were_on && !drive) result.off_after_s = std::max(0.0, driven_until_s - result.injected_at_s);
  // The self-test pulses of the start-up are over.
  const bool may_pulse = the_case.situation == CaseSituation::starting;
  result.bridges_went_on = !result.bridges_were_on && (may_pulse ? drive : driven_until_s > result.injected_at_s);
  result.peak_force_N = reading.peak_force_N;
  result.energy_J = reading.energy_J;
  result.travel_m = the_case.situation == CaseSituation::motion ? reading.lag_m : reading.travel_m;
  result.locked_up = board.is_locked_up();
  const unsigned resets = board.resets() - resets_before;
  result.restarts = resets - std::min(resets, resets_meant(board, the_case));
  result.missed_boot_loader = the_case.situation == CaseSituation::update && !board.is_in_boot_loader();
}

/// Records the reported fault unless the situation caused the fault.
void note_fault(const BoardRun& board, const Result& result, protocol::Fault& fault) {
  if (fault != protocol::Fault::none || !board.is(State::fault)) return;
  if (board.pose()->fault != result.told_before) fault = board.pose()->fault;
}

/// Returns FirstFault::none if the board does not answer.
FirstFault outcome_of_first_fault(BoardRun& board, bool restarted) {
  if (board.is(State::fault) && board.pose()->fault == first_fault) return FirstFault::reported;
  try {
    // A board that has not restarted still reports the fault.
    return restarted && board.device().black_box().fault == first_fault ? FirstFault::black_box : FirstFault::lost;
  } catch (const device::Error&) {
    return FirstFault::none;
  }
}

/// Clears the first fault and records the next report.
void clear_first_fault(BoardRun& board, Result& result) {
  const auto driven_until_s = [&] { return board.control().truth().at("bridges_driven_until_s").get<double>(); };
  const double before_s = driven_until_s();
  board.command(Command::clear_fault);
  board.run(0.1);
  note_fault(board, result, result.told_once_cleared);
  result.bridges_went_on |= driven_until_s() > before_s;
}

/// Returns true if the force could be switched on.
bool try_to_work(BoardRun& board) {
  try {
    if (!board.connected() && !board.connect(0.5)) return false;
    board.set({{Parameter::host_timeout_s, 0.5f}});
    return regain_force(board);
  } catch (const device::Error&) {
    return false;
  }
}

/// Records the board's reports. Returns false if the board cannot report.
bool notice(BoardRun& board, const Case& the_case, Result& result) {
  board.run(0.02, false);
  note_fault(board, result, result.detected_as);
  if (!is_about_the_host(the_case.fault) && board.is_in_boot_loader()) board.start_from_boot_loader();
  // A restarted board with working USB reports the cause.
  if ((result.restarts > 0 || !board.connected()) && !is_about_the_host(the_case.fault) &&
      board.connect_after_restart())
    note_fault(board, result, result.detected_as);
  if (!board.connected()) return false;
  if (the_case.situation == CaseSituation::fault && !is_about_the_host(the_case.fault)) {
    result.first_fault = outcome_of_first_fault(board, result.restarts > 0);
    if (result.first_fault == FirstFault::reported) clear_first_fault(board, result);
  }
  return true;
}

/// Waits until the board runs its boot loader, and commands the boot loader to start the firmware.
void leave_boot_loader(BoardRun& board, Result& result) {
  constexpr double poll_interval_s = 0.005, longest_s = 0.5;
  for (double waited_s = 0; waited_s < longest_s; waited_s += poll_interval_s) {
    board.run(poll_interval_s);
    if (board.is_in_boot_loader()) {
      if (std::exchange(result.missed_boot_loader, false)) result.restarts -= std::min(result.restarts, 1u);
      board.start_from_boot_loader();
      return;
    }
    if (!board.connected()) board.connect(0);
    if (board.pose() && !board.is(State::update)) return;
  }
}

/// Clears the fault and restores the force. If `could_report` is true, later detections are ignored.
void recover(BoardRun& board, const Case& the_case, bool could_report, Result& result) {
  board.control().heal_all();
  if (the_case.situation == CaseSituation::update) leave_boot_loader(board, result);
  if (!board.connected()) board.connect(0.5);
  board.run(0.05);
  if (the_case.situation == CaseSituation::fault && result.first_fault == FirstFault::none && board.connected())
    result.first_fault = outcome_of_first_fault(board, result.restarts > 0);
  if (result.detected_as == protocol::Fault::none && result.told_once_cleared == protocol::Fault::none &&
      result.noticed_in_use_as.by == NoticedInUse::By::nothing)
    note_fault(board, result, could_report ? result.fault_on_healing : result.detected_as);
  const bool stayed = is_active(the_case.situation) ? board.force_is_on() : result.restarts == 0;
  const bool was_fault = board.is(State::fault);
  if (try_to_work(board)) {
    result.recovery = was_fault ? Recovery::clear_fault : stayed ? Recovery::none_needed : Recovery::force_on_again;
  } else {
    board.reset();
    result.recovery = try_to_work(board) ? Recovery::board_reset : Recovery::not_recovered;
  }
  if (!board.pose() || !board.force_is_on()) return;
  const Vector3 true_m = board.true_position_m();
  double squares = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    squares += std::pow(static_cast<double>(board.pose()->position_m[axis]) - true_m[axis], 2);
  result.position_error_m = std::sqrt(squares);
}

}  // namespace

Result run_case(const Case& the_case, device::VirtualBoardOptions options) {
  Result result{
      .number = the_case.number, .fault = the_case.fault, .situation = the_case.situation, .phase = the_case.phase};
  options.real_time = false;
  options.paused = true;
  options.seconds = longest_case_s;
  options.brown_out_level = 3;  // setting of a flashed board
  // All cases of a phase have the same seed, except cases in which the seed chooses the fault address.
  const auto& fault = the_case.fault.fault;
  const bool chooses = fault && protocol::info(*fault).location == protocol::InjectionLocation::address;
  options.seed = chooses ? the_case.number : the_case.phase;
  try {
    std::optional<local::PrivateFolder> folder;
    if (the_case.situation == CaseSituation::starting) {
      folder.emplace(local::PrivateFolder::for_files());
      options.flash = folder->path() / "flash";
      write_confirmed_board(options, options.flash);
    }
    BoardRun board(options);
    const ParameterSet parameters = bring_into(board, the_case);
    result.force_limit_N = static_cast<double>(parameters[Parameter::force_limit_N]);
    const double until_fault_s = phase_s(the_case);
    constexpr double whole_slices_s = 0.01;
    const double slices_s = std::floor(until_fault_s / whole_slices_s) * whole_slices_s;
    board.run(slices_s);
    board.run_exactly(until_fault_s - slices_s);
    expect(the_case.situation != CaseSituation::update || board.is(State::update), "the board left too soon.");
    if (the_case.situation == CaseSituation::fault) result.told_before = first_fault;
    observe(board, the_case, parameters, result);
    const bool could_report = notice(board, the_case, result);
    const bool lasts = is_active(the_case.situation) && the_case.situation != CaseSituation::landing;
    if (lasts && is_unnoticed(result) && could_report && !is_about_the_host(the_case.fault))
      use_on(board, parameters, result);
    recover(board, the_case, could_report, result);
  } catch (const device::Error& error) {
    result.error = error.what();
  }
  return result;
}

}  // namespace inkwell::campaign
