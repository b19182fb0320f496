// Tests that simulated quantities are stored in one row per period.
#include <doctest/doctest.h>

#include "host/lab/experiment/simulated_columns.hpp"

using namespace inkwell;
using namespace inkwell::experiment;
using protocol::SimulatedQuantity;
using recording::Recording;

namespace {

Recording recorded(std::uint32_t first_period, std::size_t samples) {
  recording::Information about;
  about.signals = {protocol::Signal::force_N};
  auto recording = Recording::without_samples(about);
  recording.append({about.signals, first_period, samples, std::vector<float>(samples, 1.0f), 0});
  return recording;
}

/// A trace in the format of a virtual board. Each quantity is the period number plus a thousandth of its column number.
device::Trace trace_of(std::uint64_t first_period, std::size_t rows) {
  device::Trace trace;
  trace.columns = {"period", "board_time_s"};
  for (const auto& row : protocol::simulated_quantity_table) trace.columns.emplace_back(row.name);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < trace.columns.size(); ++j)
      trace.values.push_back(static_cast<double>(first_period + i) + (j == 0 ? 0 : 0.001 * static_cast<double>(j)));
  return trace;
}

}  // namespace

TEST_CASE("the simulation's columns are matched by control period") {
  auto recording = recorded(12, 3);
  add_simulated_columns(recording, trace_of(10, 5),
                        {SimulatedQuantity::true_position_x_m, SimulatedQuantity::true_supply_V});
  CHECK(recording.size() == 3);
  CHECK(recording.column(SimulatedQuantity::true_position_x_m) == std::vector{12.002f, 13.002f, 14.002f});
  CHECK(recording.column(SimulatedQuantity::true_supply_V)[2] == 14.026f);
  CHECK(recording.column(protocol::Signal::force_N)[0] == 1.0f);
  CHECK(recorded_quantities().size() == 9);
}

TEST_CASE("a trace that does not cover the recording is an error") {
  auto later = recorded(12, 4), earlier = recorded(9, 1), whole = recorded(10, 5);
  CHECK_THROWS_AS(add_simulated_columns(later, trace_of(10, 5), recorded_quantities()), device::Error);
  CHECK_THROWS_AS(add_simulated_columns(earlier, trace_of(10, 5), recorded_quantities()), device::Error);
  CHECK_THROWS_AS(add_simulated_columns(whole, trace_of(10, 0), recorded_quantities()), device::Error);
  auto gap = trace_of(10, 5);
  gap.values[3 * gap.columns.size()] = 99;
  CHECK_THROWS_AS(add_simulated_columns(whole, gap, recorded_quantities()), device::Error);
  auto without = trace_of(10, 5);
  without.columns[2] = "something_else";
  CHECK_THROWS_AS(add_simulated_columns(whole, without, recorded_quantities()), device::Error);
}
