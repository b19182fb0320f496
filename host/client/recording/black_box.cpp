#include "host/client/recording/black_box.hpp"

#include <fmt/format.h>

#include "host/client/device/wide_counter.hpp"

namespace inkwell::recording {

using device::WideCounter;

std::vector<protocol::Signal> black_box_signals() {
  std::vector<protocol::Signal> signals;
  for (const auto& row : protocol::known_signals()) signals.push_back(static_cast<protocol::Signal>(row.id));
  return signals;
}

Recording of_black_box(const protocol::BlackBoxReport& box, std::span<const protocol::BlackBoxRow> rows,
                       Information about) {
  const auto fault = protocol::info(box.fault).name;
  if (rows.empty())
    throw device::Error(
        fmt::format("The black box of {} contains no signals: the board restarted before it recorded any.", fault));
  about.step_periods = protocol::black_box_step_periods;
  auto recording = Recording::without_samples(std::move(about));
  for (const auto& row : rows) {
    const std::int64_t period = recording.size() == 0
                                    ? std::int64_t{row.time_periods}
                                    : WideCounter::nearest_to(recording.periods.back(), row.time_periods);
    if (recording.size() > 0 && period <= recording.periods.back())
      throw device::Error(fmt::format(
          "The black box of {} is damaged: its rows are not in chronological order. Nothing was saved.", fault));
    recording.periods.push_back(period);
    for (std::size_t i = 0; i < recording.columns.size(); ++i)
      recording.columns[i].push_back(row.values[static_cast<std::size_t>(recording.information.signals[i])]);
  }
  recording.marks.push_back(
      {WideCounter::nearest_to(recording.periods.front(), box.fault_periods), std::string(fault)});
  return recording;
}

}  // namespace inkwell::recording
