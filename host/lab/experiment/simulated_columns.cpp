#include "host/lab/experiment/simulated_columns.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace inkwell::experiment {
namespace {

std::size_t column_index(const device::Trace& trace, std::string_view name) {
  const auto found = std::find(trace.columns.begin(), trace.columns.end(), name);
  if (found == trace.columns.end())
    throw device::Error(fmt::format(
        "The virtual board's trace has no {}. Build the virtual board and the companion from the same source.", name));
  return static_cast<std::size_t>(found - trace.columns.begin());
}

}  // namespace

std::vector<protocol::SimulatedQuantity> recorded_quantities() {
  using enum protocol::SimulatedQuantity;
  return {true_position_x_m, true_position_y_m, true_position_z_m, true_current_1_A, true_current_2_A,
          true_current_3_A,  hand_force_x_N,    hand_force_y_N,    hand_force_z_N};
}

void add_simulated_columns(recording::Recording& recording, const device::Trace& trace,
                           const std::vector<protocol::SimulatedQuantity>& quantities) {
  const std::size_t width = trace.columns.size(), period_column = column_index(trace, "period");
  std::vector<std::size_t> columns;
  for (const auto quantity : quantities) columns.push_back(column_index(trace, info(quantity).name));
  recording.information.simulated = quantities;
  recording.simulated_columns.assign(quantities.size(), {});
  if (recording.size() == 0) return;

  // The trace has one row for each control period, without gaps.
  const std::size_t rows = trace.row_count();
  // The trace counts all periods since the reset. The period counter of the recording may have wrapped.
  const auto period_of = [&](std::size_t row) {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(trace.values[row * width + period_column]));
  };
  const std::uint32_t first_period = rows == 0 ? 0 : period_of(0);
  for (const std::int64_t period : recording.periods) {
    const std::size_t row = static_cast<std::uint32_t>(period) - first_period;
    if (row >= rows || period_of(row) != static_cast<std::uint32_t>(period))
      throw device::Error(
          fmt::format("The virtual board's trace lacks control period {}. Run the experiment again.", period));
    for (std::size_t j = 0; j < columns.size(); ++j)
      recording.simulated_columns[j].push_back(static_cast<float>(trace.values[row * width + columns[j]]));
  }
}

}  // namespace inkwell::experiment
