#include "use.hpp"

#include <vector>

#include <campaign/handling.hpp>
#include <campaign/run.hpp>
#include <protocol/reports.hpp>

namespace inkwell::campaign {
namespace {

using device::HandWaypoint;
using protocol::State;

/// Until a swinging hand has come to the end of its way.
constexpr double goes_on_s = 0.6;

std::vector<HandWaypoint> pressing_and_swinging(const protocol::ParameterSet& parameters) {
  const device::Vector3 middle_m = middle_of_box_m(parameters);
  const device::Vector3 pressed_m = beyond_forward_wall_m(parameters, 1.0);
  std::vector<HandWaypoint> path;
  double at_s = 0.1;
  path.push_back({at_s, middle_m});
  for (int press = 0; press < use_presses; ++press)
    for (const auto& target_m : {pressed_m, middle_m}) {
      path.push_back({at_s += 0.15, target_m});
      path.push_back({at_s += 0.1, target_m});
    }
  for (const HandWaypoint& swung : swings(middle_m, use_swings)) path.push_back({at_s + swung.after_s, swung.target_m});
  path.push_back({at_s + use_swings * swing_s + 0.2, middle_m});
  return path;
}

}  // namespace

void use_on(BoardRun& board, Result& result) {
  auto& control = board.control();
  const unsigned restarts_before = control.status().all.value("resets", 0u);
  control.meter_start();
  double used_s = 0;
  const auto use_for = [&](double time_s) {
    constexpr double look_s = 0.01;
    for (const double until_s = used_s + time_s; used_s < until_s; used_s += look_s) {
      if (!board.connected() || board.is(State::fault)) return;
      board.run(look_s);
    }
  };
  use_for(goes_on_s);
  if (board.connected() && !board.is(State::fault)) {
    const auto path = pressing_and_swinging(board.device().parameters());
    control.hand_path(path);
    use_for(path.back().after_s);
  }
  result.peak_force_in_use_N = control.meter_read().peak_force_N;
  if (board.is(State::fault))
    result.noticed_in_use_as = protocol::info(board.pose()->fault).name;
  else if (control.status().all.value("resets", 0u) > restarts_before)
    result.noticed_in_use_as = "restart";
  if (!result.noticed_in_use_as.empty()) result.noticed_in_use_s = used_s;
}

}  // namespace inkwell::campaign
