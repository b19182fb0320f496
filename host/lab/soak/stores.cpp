// Stored parameters across restarts.
#include <fmt/format.h>

#include "host/client/device/board_store.hpp"

#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {
namespace {

using protocol::Command;
using protocol::StoreResult;

/// Checks the result of a command that stores or erases parameters.
void expect(Bench& bench, Command command, StoreResult expected) {
  constexpr double longest_s = 1.0, step_s = 0.01;
  bench.board.command(command);
  StoreResult result = StoreResult::under_way;
  for (double waited_s = 0; result == StoreResult::under_way && waited_s < longest_s; waited_s += step_s) {
    bench.pass(step_s);
    result = device::read_store(bench.board.device()).report.result;
  }
  if (result != expected)
    bench.fail(Complaint::no_answer,
               fmt::format("the store reported \"{}\" instead of \"{}\"", info(result).name, info(expected).name));
}

/// Restarts the chip during a write. Afterwards either the previous or the new parameters are stored.
bool cut_off(Bench& bench) {
  const auto wanted = bench.accepted;
  bench.board.command(Command::store_parameters);
  bench.pass(bench.random.from(0.0, 0.15));
  bench.reset();
  const bool is_stored = bench.board.device().parameters() == wanted;
  if (is_stored) bench.hold(bench.stored = wanted);
  bench.check_parameters();
  return is_stored;
}

}  // namespace

std::string store_parameters(Bench& bench) {
  bench.make_ready();
  Random& random = bench.random;
  const auto change = [&] { bench.set(legal_changes(random, bench.accepted, Reach::careful, 1 + random.below(20))); };

  change();
  const bool is_cut_off = random.chance(0.5);
  const bool is_stored = !is_cut_off || cut_off(bench);
  if (!is_cut_off) {
    expect(bench, Command::store_parameters, StoreResult::done);
    bench.stored = bench.accepted;
  }

  bench.make_active();
  change();
  expect(bench, Command::store_parameters, StoreResult::force_is_on);
  bench.withdraw_force();
  bench.pass(0.1);
  if (is_stored) {
    bench.board.device().restore_stored_parameters();
    bench.hold(bench.stored);
    bench.check_parameters();
  }
  bench.reset();
  bench.check_parameters();

  bench.make_ready();
  expect(bench, Command::factory_reset, is_stored ? StoreResult::done : StoreResult::nothing_stored);
  bench.hold(bench.stored = bench.defaults);
  bench.check_parameters();
  bench.make_active();
  return is_cut_off ? fmt::format("cut off {} it was stored", is_stored ? "after" : "before") : "stored";
}

}  // namespace inkwell::soak
