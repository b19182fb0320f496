// A recording whose samples are read on demand, so that a part of a long recording needs little time and memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/client/recording/band.hpp"
#include "host/client/recording/overview.hpp"
#include "host/client/recording/recording.hpp"
#include "host/client/recording/stretches.hpp"

namespace inkwell::recording {

/// Reads the values of a recording. Columns are the signals, then the simulated quantities.
class ColumnReader {
 public:
  virtual ~ColumnReader() = default;
  /// Reads the values of the samples from `begin` on. Throws device::Error if the file is damaged there.
  virtual void read(std::size_t column, std::size_t begin, std::span<float> values) = 0;
  /// Number of blocks with a stored overview. The first block starts with the first sample.
  virtual std::size_t overview_blocks() const { return 0; }
  /// Reads the overview from the block `begin` on.
  virtual void read_overview(std::size_t, std::size_t, std::span<OverviewBlock>) {}
};

/// Samples from `begin` to `end` - 1.
struct SampleRange {
  std::size_t begin, end;
};

/// Copies share the opened file. Use all copies on the same thread.
class StoredRecording {
 public:
  /// Opens a recording. The samples stay in the file. Throws device::Error like read().
  static StoredRecording open(const std::filesystem::path& file);
  /// Samples in memory.
  StoredRecording(Recording recording);  // NOLINT(google-explicit-constructor)
  /// `head`: a recording without samples.
  StoredRecording(Recording head, Stretches stretches, std::shared_ptr<ColumnReader> reader);

  std::string name;  ///< as in Recording, with the members below
  Information information;
  bool complete = true;
  std::vector<Mark> marks;
  std::vector<ClockReading> clock;
  std::vector<std::string> remarks;

  std::size_t size() const { return stretches_.size(); }
  std::int64_t period(std::size_t sample) const { return stretches_.period(sample); }
  std::int64_t first_period() const { return stretches_.first_period(); }
  double elapsed_s(std::size_t sample) const { return elapsed_s_at(period(sample)); }
  /// Returns 0 in a recording without samples.
  double elapsed_s_at(std::int64_t period) const {
    return size() == 0 ? 0.0 : device::board_time_s(period - first_period());
  }
  double duration_s() const { return size() == 0 ? 0.0 : elapsed_s(size() - 1); }
  /// Returns the index of the first sample at or after the time `elapsed_s`, or size() after the last sample.
  std::size_t sample_at(double elapsed_s) const;
  /// Returns the end of the gap-free range that contains `begin`, at most `end`.
  std::size_t end_of_stretch(std::size_t begin, std::size_t end) const;
  std::uint64_t lost() const { return stretches_.lost(information.step_periods); }

  /// Signals, then simulated quantities.
  std::vector<Quantity> quantities() const;
  /// Throws device::Error with the list of recorded quantities if the quantity was not recorded.
  std::size_t column_of(Quantity quantity) const;

  // These functions read the file. They throw device::Error if the file is damaged there.
  void read(std::size_t column, std::size_t begin, std::span<float> values) const;
  float value(std::size_t column, std::size_t sample) const;
  /// Mean and extremes: element [i][j] is column columns[j] in range i. A range of at least a thousand samples may be
  /// widened to whole blocks of the overview, but not across a gap.
  std::vector<std::vector<Band>> bands(std::span<const std::size_t> columns, std::span<const SampleRange> ranges) const;
  /// Values of some signals: element i * signals.size() + j is signal j of sample begin + i.
  std::vector<float> rows(std::size_t begin, std::size_t end, std::span<const protocol::Signal> signals) const;
  /// Samples of a range in the format of the scope. Missing periods before the range count as lost.
  device::ScopeSamples samples(std::size_t begin, std::size_t end, const std::vector<protocol::Signal>& signals) const;
  /// One sample in the format of the scope, repeated until the next sample.
  device::ScopeSamples held_sample(std::size_t sample, const std::vector<protocol::Signal>& signals) const;
  /// Loads the samples of some quantities.
  Recording load(const std::vector<Quantity>& quantities) const;

 private:
  /// Part of a range that is read from the overview, in whole blocks; empty for a short range.
  SampleRange overview_part(SampleRange range) const;
  void add_samples(std::span<BandSum> sums, std::span<const std::size_t> columns, SampleRange range) const;
  bool has_gap(std::size_t begin, std::size_t end) const { return stretches_.end_of_stretch(begin) < end; }

  Stretches stretches_;
  std::shared_ptr<ColumnReader> reader_;
};

/// Returns the signals that are in both lists, in the order of `recorded`.
std::vector<protocol::Signal> recorded_of(const std::vector<protocol::Signal>& recorded,
                                          const std::vector<protocol::Signal>& shown);

/// One line per mark: clock, time since the first sample, kind, text.
std::string log_text(const StoredRecording& recording);

}  // namespace inkwell::recording
