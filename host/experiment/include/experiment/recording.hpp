// A recording: one row for each control period, columns with names that end in their unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <device/control_client.hpp>
#include <device/scope_decoder.hpp>
#include <protocol/signals.hpp>

namespace inkwell::experiment {

/// The signals of the experiment, in the order of its columns: encoders to duties.
std::vector<protocol::Signal> recorded_signals();

class Recording {
 public:
  Recording() = default;
  explicit Recording(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t size() const { return columns_.empty() ? 0 : values_.size() / columns_.size(); }
  void append(std::span<const double> row) { values_.insert(values_.end(), row.begin(), row.end()); }

  /// Throws device::Error if there is no such column.
  std::size_t column(std::string_view name) const;
  bool has_column(std::string_view name) const;
  double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }
  std::vector<double> values_of(std::string_view name) const;

 private:
  std::vector<std::string> columns_;
  std::vector<double> values_;
};

/// Scope samples laid end to end.
struct ScopeRecording {
  std::vector<protocol::Signal> signals;
  std::uint32_t first_period = 0;
  std::vector<float> values;
  std::uint64_t lost_samples = 0;

  std::size_t size() const { return signals.empty() ? 0 : values.size() / signals.size(); }
  void append(const device::ScopeSamples& samples);
};

/// The table that is written: time_s, the signals, and, if there is a trace, what the simulation knows. Rows are
/// matched by control period. Throws device::Error if the trace does not cover the scope's periods.
Recording make_recording(const ScopeRecording& scope, const device::Trace* truth);

/// Reads what write_csv has written. Throws device::Error that names the line if it is damaged.
Recording read_csv(const std::filesystem::path& file);
/// Throws device::Error if the file cannot be written whole.
void write_csv(const Recording& recording, const std::filesystem::path& file);

}  // namespace inkwell::experiment
