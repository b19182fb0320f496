#include <recording/black_box.hpp>

#include <fmt/format.h>

namespace inkwell::recording {

std::vector<protocol::Signal> black_box_signals() {
  std::vector<protocol::Signal> signals;
  for (const auto& row : protocol::known_signals()) signals.push_back(static_cast<protocol::Signal>(row.id));
  return signals;
}

Recording of_black_box(const protocol::BlackBoxReport& box, std::span<const protocol::BlackBoxRow> rows,
                       Information about) {
  const auto fault = protocol::info(box.fault).name;
  if (rows.empty())
    throw device::Error(fmt::format(
        "The black box of {} holds no signals: the board was restarted before it had recorded any.", fault));
  about.step_periods = protocol::black_box_step_periods;
  auto recording = Recording::without_samples(std::move(about));
  for (const auto& row : rows) {
    // Unsigned, so that it is right across the wrap of the board's counter.
    const bool rises = recording.size() == 0 || row.time_periods - recording.periods.back() - 1 < 0x7FFF'FFFF;
    if (!rises)
      throw device::Error(fmt::format(
          "The black box of {} is damaged: its rows are not in the order of time. Nothing was saved.", fault));
    recording.periods.push_back(row.time_periods);
    for (std::size_t i = 0; i < recording.columns.size(); ++i)
      recording.columns[i].push_back(row.values[static_cast<std::size_t>(recording.information.signals[i])]);
  }
  recording.marks.push_back({box.fault_periods, std::string(fault)});
  return recording;
}

}  // namespace inkwell::recording
