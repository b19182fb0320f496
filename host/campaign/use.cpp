#include "use.hpp"

#include <vector>

#include <campaign/handling.hpp>
#include <campaign/run.hpp>
#include <protocol/reports.hpp>

namespace inkwell::campaign {
namespace {

using device::HandWaypoint;
using protocol::State;

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

void use_on(BoardRun& board, const protocol::ParameterSet& parameters, Result& result) {
  auto& control = board.control();
  const unsigned resets_before = board.resets();
  control.meter_start();
  double used_s = 0;
  const auto use_for = [&](double time_s) {
    constexpr double look_s = 0.01;
    for (const double until_s = used_s + time_s; used_s < until_s; used_s += look_s) {
      if (!board.connected() || !board.force_is_on()) return;
      board.run(look_s);
    }
  };
  use_for(goes_on_s);
  const auto path = pressing_and_swinging(parameters);
  if (board.connected() && board.force_is_on()) control.hand_path(path);
  use_for(path.back().after_s);
  const bool restarted = board.resets() > resets_before;
  if (!board.connected() && !restarted) return;  // a device that cannot be used
  if (!restarted && board.force_is_on()) {
    result.peak_force_in_use_N = control.meter_read().peak_force_N;
    return;
  }
  result.noticed_in_use_s = used_s;
  board.run(observed_s, false);  // what the hand feels then counts as well
  result.peak_force_in_use_N = control.meter_read().peak_force_N;
  if (restarted && !board.connected()) board.connect_after_restart();
  result.noticed_in_use_as = board.is(State::fault) ? protocol::info(board.pose()->fault).name
                             : restarted            ? "restart"
                                                    : "force off";
}

}  // namespace inkwell::campaign
