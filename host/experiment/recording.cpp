#include <experiment/recording.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include <protocol/reports.hpp>

namespace inkwell::experiment {
namespace {

constexpr std::array<std::string_view, 9> truth_columns = {
    "true_position_x_m", "true_position_y_m", "true_position_z_m", "true_current_1_A", "true_current_2_A",
    "true_current_3_A",  "hand_force_x_N",    "hand_force_y_N",    "hand_force_z_N"};

std::size_t index_of(const std::vector<std::string>& columns, std::string_view name) {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end())
    throw device::Error(
        fmt::format("The column {} is missing. Build the virtual board and the companion from the same "
                    "source.",
                    name));
  return static_cast<std::size_t>(found - columns.begin());
}

/// Finds the row of a control period; the trace has one row for each, without gaps.
class TruthRows {
 public:
  explicit TruthRows(const device::Trace& trace) : trace_(trace) {
    period_ = index_of(trace.columns, "period");
    for (std::size_t i = 0; i < truth_columns.size(); ++i) columns_[i] = index_of(trace.columns, truth_columns[i]);
    if (trace.row_count() > 0) first_period_ = static_cast<std::uint64_t>(trace.values[period_]);
  }

  void append(std::uint64_t period, std::vector<double>& row) const {
    const std::size_t width = trace_.columns.size();
    const std::uint64_t index = period - first_period_;
    const bool known = period >= first_period_ && index < trace_.row_count() &&
                       trace_.values[index * width + period_] == static_cast<double>(period);
    if (!known)
      throw device::Error(
          fmt::format("The virtual board's trace lacks control period {}. Run the experiment again.", period));
    for (std::size_t column : columns_) row.push_back(trace_.values[index * width + column]);
  }

 private:
  const device::Trace& trace_;
  std::size_t period_ = 0;
  std::array<std::size_t, truth_columns.size()> columns_{};
  std::uint64_t first_period_ = 0;
};

}  // namespace

std::vector<protocol::Signal> recorded_signals() {
  std::vector<protocol::Signal> signals;
  for (auto i = static_cast<int>(protocol::Signal::encoder_1_counts); i <= static_cast<int>(protocol::Signal::duty_3);
       ++i)
    signals.push_back(static_cast<protocol::Signal>(i));
  return signals;
}

std::size_t Recording::column(std::string_view name) const { return index_of(columns_, name); }

bool Recording::has_column(std::string_view name) const {
  return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

std::vector<double> Recording::values_of(std::string_view name) const {
  const std::size_t index = column(name);
  std::vector<double> result(size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = at(i, index);
  return result;
}

void ScopeRecording::append(const device::ScopeSamples& samples) {
  if (values.empty()) {
    signals = samples.signals;
    first_period = samples.first_period;
  }
  lost_samples += samples.lost_before;
  values.insert(values.end(), samples.values.begin(), samples.values.end());
}

Recording make_recording(const ScopeRecording& scope, const device::Trace* truth) {
  std::vector<std::string> columns{"time_s"};
  for (auto signal : scope.signals) columns.emplace_back(info(signal).name);
  if (truth != nullptr) columns.insert(columns.end(), truth_columns.begin(), truth_columns.end());
  Recording recording(columns);

  std::optional<TruthRows> truth_rows;
  if (truth != nullptr) truth_rows.emplace(*truth);
  std::vector<double> row;
  const std::size_t width = scope.signals.size();
  for (std::size_t i = 0; i < scope.size(); ++i) {
    row.assign(1, static_cast<double>(i) / protocol::servo_rate_Hz);
    row.insert(row.end(), scope.values.begin() + static_cast<std::ptrdiff_t>(i * width),
               scope.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
    if (truth_rows) truth_rows->append(std::uint64_t{scope.first_period} + i, row);
    recording.append(row);
  }
  return recording;
}

Recording read_csv(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (!std::getline(stream, line)) throw device::Error(fmt::format("{} cannot be read.", file.string()));
  std::vector<std::string> columns;
  std::string cell;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) columns.push_back(cell);
  Recording recording(columns);
  std::vector<double> row(columns.size());
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto [next, error] = std::from_chars(at, end, row[i]);
      const bool is_last = i + 1 == row.size();
      if (error != std::errc{} || (is_last ? next != end : next == end || *next != ','))
        throw device::Error(fmt::format("{} is damaged in line {}. Run the experiment again, or use a whole copy.",
                                        file.string(), number));
      at = next + 1;
    }
    recording.append(row);
  }
  return recording;
}

void write_csv(const Recording& recording, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}\n", fmt::join(recording.columns(), ","));
  const std::size_t width = recording.columns().size();
  for (std::size_t i = 0; i < recording.size() && stream; ++i) {
    // Nine digits give every float back exactly.
    for (std::size_t j = 0; j < width; ++j)
      fmt::format_to(out, "{:.9g}{}", recording.at(i, j), j + 1 < width ? ',' : '\n');
    if (text.size() > (1u << 20)) {
      stream.write(text.data(), static_cast<std::streamsize>(text.size()));
      text.clear();
    }
  }
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream)
    throw device::Error(fmt::format("{} cannot be written whole. Check the folder, your permission and the space left.",
                                    file.string()));
}

}  // namespace inkwell::experiment
