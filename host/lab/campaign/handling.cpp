#include "host/lab/campaign/handling.hpp"

#include <cmath>
#include <cstddef>

#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/run.hpp"

namespace inkwell::campaign {
namespace {

using device::Vector3;
using protocol::Command;
using protocol::Parameter;
using protocol::ParameterSet;
using protocol::State;

// A switching bridge drives a leg high in each PWM period of 17 us.
constexpr double still_driving_s = 200e-6;

}  // namespace

Vector3 middle_of_box_m(const ParameterSet& parameters) {
  Vector3 middle{};
  for (int axis = 0; axis < 3; ++axis)
    middle[static_cast<std::size_t>(axis)] =
        (experiment::wall_position_m(parameters, {axis, 1}) + experiment::wall_position_m(parameters, {axis, -1})) / 2;
  return middle;
}

Vector3 into_wall_m(const ParameterSet& parameters, experiment::BoxWall wall, double force_N) {
  const double stiffness_N_per_m = static_cast<double>(parameters[Parameter::wall_stiffness_N_per_m]);
  const double contact_m = experiment::wall_position_m(parameters, wall) -
                           wall.side * static_cast<double>(parameters[Parameter::sphere_radius_m]);
  Vector3 target_m = middle_of_box_m(parameters);
  target_m[static_cast<std::size_t>(wall.axis)] =
      contact_m + wall.side * (force_N / hand_stiffness_N_per_m + force_N / stiffness_N_per_m);
  return target_m;
}

Vector3 beyond_forward_wall_m(const ParameterSet& parameters, double part_of_limit) {
  const double force_N = part_of_limit * static_cast<double>(parameters[Parameter::force_limit_N]);
  return into_wall_m(parameters, experiment::forward_wall(parameters), force_N);
}

std::vector<device::HandWaypoint> swings(const Vector3& middle_m, int count) {
  std::vector<device::HandWaypoint> path;
  for (int turn = 0; turn < count; ++turn) {
    Vector3 side_m = middle_m;
    for (double& along_m : side_m) along_m += (turn % 2 == 0 ? swing_m : -swing_m) / std::sqrt(3.0);
    path.push_back({(turn + 1) * swing_s, side_m});
  }
  return path;
}

std::vector<device::HandWaypoint> fling(const Vector3& middle_m) {
  constexpr double draws_back_s = 0.12, rests_s = 0.02, returns_s = 0.1;
  Vector3 back_m = middle_m, forth_m = middle_m;
  back_m[0] -= fling_m / 2;
  forth_m[0] += fling_m / 2;
  const double flung_s = draws_back_s + fling_s;
  return {{draws_back_s, back_m},
          {flung_s, forth_m},
          {flung_s + rests_s, forth_m},
          {flung_s + rests_s + returns_s, middle_m}};
}

std::vector<device::HandWaypoint> pressing_and_swinging(const protocol::ParameterSet& parameters) {
  const Vector3 middle_m = middle_of_box_m(parameters);
  const double force_N = static_cast<double>(parameters[Parameter::force_limit_N]);
  const Vector3 forward_m = beyond_forward_wall_m(parameters, 1.0);
  const Vector3 aside_m = into_wall_m(parameters, experiment::side_wall(parameters), force_N);
  std::vector<device::HandWaypoint> path;
  double at_s = 0.1;
  path.push_back({at_s, middle_m});
  for (int press = 0; press < use_presses; ++press)
    for (const auto& target_m : {forward_m, middle_m, aside_m, middle_m}) {
      path.push_back({at_s += 0.15, target_m});
      path.push_back({at_s += 0.1, target_m});
    }
  for (const device::HandWaypoint& swung : swings(middle_m, use_swings))
    path.push_back({at_s + swung.after_s, swung.target_m});
  path.push_back({at_s + use_swings * swing_s + 0.2, middle_m});
  return path;
}

void take_by_hand(BoardRun& board, Vector3 target_m, double duration_s) {
  const Vector3 here_m = board.true_position_m();
  board.control().hand({true, here_m, hand_stiffness_N_per_m, hand_damping_Ns_per_m});
  board.control().dock(false);
  board.control().hand_path({{0.0, here_m}, {duration_s, target_m}});
}

bool bridges_drive(const nlohmann::json& truth) {
  return truth.at("board_time_s").get<double>() - truth.at("bridges_driven_until_s").get<double>() < still_driving_s;
}

bool regain_force(BoardRun& board) {
  board.run(0.02);
  if (board.is(State::fault)) {
    // The board refuses the command until the cause is gone, so the command is repeated.
    const auto is_cleared = [](const auto& pose) { return pose.state != State::fault; };
    for (int times = 0; times < 5 && board.is(State::fault); ++times) {
      board.command(Command::clear_fault);
      board.wait_for(is_cleared, 0.1);
    }
    if (board.is(State::fault)) return false;
  }
  if (board.is(State::starting) || board.is(State::testing)) board.run(0.3);
  if (board.is(State::unreferenced)) {
    board.control().dock(true);
    if (!board.wait_for(State::ready, 2.0)) return false;
  }
  if (board.is(State::ready) || board.is(State::landing)) board.command(Command::enable_force);
  if (!board.wait_for([](const auto& pose) { return protocol::force_is_on(pose.state); }, 0.5)) return false;
  board.run(0.1);
  return board.force_is_on() && bridges_drive(board.control().truth());
}

}  // namespace inkwell::campaign
