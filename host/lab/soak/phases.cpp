#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {

std::string play(Bench& bench, Kind kind) {
  const double time_s = bench.random.from(0.3, 1.0) * bench.choices.use_s;
  switch (kind) {
    case Kind::docking: return use_docking(bench);
    case Kind::free_space: return use_free_space(bench, time_s);
    case Kind::walls: return use_walls(bench, time_s);
    case Kind::fast: return use_fast(bench, time_s);
    case Kind::program: return use_program(bench, time_s);
    case Kind::scope: return use_scope(bench, time_s);
    case Kind::recording: return use_recording(bench, time_s);
    case Kind::live_storm: return live_storm(bench, time_s);
    case Kind::wide_storm: return wide_storm(bench, time_s);
    case Kind::store: return store_parameters(bench);
    case Kind::cable: return pull_cable(bench);
    case Kind::silence: return be_silent(bench);
    case Kind::killed: return kill_program(bench);
    case Kind::reset: return reset_board(bench);
    case Kind::too_fast: return be_too_fast(bench);
    case Kind::fault: return put_fault_in(bench);
  }
  return {};
}

}  // namespace inkwell::soak
