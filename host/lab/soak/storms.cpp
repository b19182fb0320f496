// Random parameters with the force off.
#include <fmt/format.h>

#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {

std::string wide_storm(Bench& bench, double time_s) {
  using protocol::Command;
  using protocol::State;
  bench.make_ready();
  Random& random = bench.random;
  unsigned changes = 0, illegal = 0;
  const double begin_s = bench.oracle.board_time_s();
  while (bench.oracle.board_time_s() - begin_s < time_s) {
    bench.pass(random.chance(0.8) ? random.from(0.001, 0.01) : random.from(0.01, 0.1));
    if (random.chance(0.2)) {
      bench.try_illegal();
      ++illegal;
    } else if (random.chance(0.05)) {
      bench.restore_defaults();
    } else {
      const std::size_t count = random.chance(0.1) ? protocol::parameter_count : 1 + random.below(8);
      bench.set(legal_changes(random, bench.accepted, Reach::whole, count));
      ++changes;
    }
    if (random.chance(0.1)) bench.check_parameters();
    if (bench.board.is(State::fault) && random.chance(0.2)) bench.board.command(Command::clear_fault);
  }
  bench.restore_defaults();
  bench.check_parameters();
  bench.pass(0.02);
  bench.go_on();
  return fmt::format("{} transactions, {} of them illegal", changes, illegal);
}

}  // namespace inkwell::soak
