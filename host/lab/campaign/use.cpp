#include "host/lab/campaign/use.hpp"

#include "host/lab/campaign/handling.hpp"
#include "host/lab/campaign/run.hpp"
#include "protocol/reports.hpp"

namespace inkwell::campaign {
void use_on(BoardRun& board, const protocol::ParameterSet& parameters, Result& result) {
  auto& control = board.control();
  const unsigned resets_before = board.resets();
  const auto read_meter = [&] {
    const auto reading = control.meter_read();
    result.peak_force_in_use_N = reading.peak_force_N;
    result.energy_in_use_J = reading.energy_J;
  };
  control.meter_start();
  double used_s = 0;
  const auto use_for = [&](double time_s) {
    constexpr double poll_interval_s = 0.01;
    const double until_s = used_s + time_s;
    while (used_s < until_s) {
      if (!board.connected() || !board.force_is_on()) return;
      board.run(poll_interval_s);
      used_s += poll_interval_s;
    }
  };
  use_for(goes_on_s);
  const auto path = pressing_and_swinging(parameters);
  if (board.connected() && board.force_is_on()) control.hand_path(path);
  use_for(path.back().after_s);
  const bool restarted = board.resets() > resets_before;
  if (!board.connected() && !restarted) return;  // the device cannot be used
  if (!restarted && board.force_is_on()) {
    read_meter();
    return;
  }
  result.noticed_in_use_s = used_s;
  board.run(observed_s, false);  // includes the force on the hand during this time
  read_meter();
  if (restarted && !board.connected()) board.connect_after_restart();
  if (board.is(protocol::State::fault))
    result.noticed_in_use_as = {NoticedInUse::By::fault, board.pose()->fault};
  else
    result.noticed_in_use_as = {restarted ? NoticedInUse::By::restart : NoticedInUse::By::force_off};
}

}  // namespace inkwell::campaign
