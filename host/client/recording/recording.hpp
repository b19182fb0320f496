// A recording in memory: read from a file, or growing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/event.hpp"
#include "host/client/device/scope_decoder.hpp"
#include "host/client/recording/information.hpp"
#include "host/client/recording/quantity.hpp"

namespace inkwell::recording {

/// A note of the user or an event of the device.
struct Mark {
  std::int64_t period;  ///< control period of the note or of the event
  std::string text;
  device::EventKind kind = device::EventKind::mark;
  std::string clock_utc = {};  ///< in the format of device::clock_utc_now(); empty if unknown
};

/// Time of the computer when the sample of a control period arrived.
struct ClockReading {
  std::int64_t period;
  std::int64_t utc_us;  ///< microseconds since 1970-01-01
};

struct Recording {
  std::string name;  ///< file name without folder and extension
  Information information;
  /// False: samples were lost, the link was lost, or the writer stopped before the end of the recording.
  bool complete = true;
  std::vector<std::int64_t> periods;
  std::vector<std::vector<float>> columns;  ///< one for each entry of information.signals, with the length of `periods`
  std::vector<std::vector<float>> simulated_columns;  ///< one for each entry of information.simulated
  std::vector<Mark> marks;                            ///< sorted by period after reading
  std::vector<ClockReading> clock;                    ///< about one for each second
  std::vector<std::string> remarks;                   ///< sentences about contents that this version cannot interpret

  static Recording without_samples(Information information);

  std::size_t size() const { return periods.size(); }
  /// Board time since the first sample.
  double elapsed_s(std::size_t sample) const { return elapsed_s_at(periods[sample]); }
  /// Returns 0 in a recording without samples.
  double elapsed_s_at(std::int64_t period) const {
    return periods.empty() ? 0.0 : device::board_time_s(period - periods.front());
  }
  /// Duration from the first to the last sample, or 0 without samples.
  double duration_s() const { return periods.empty() ? 0.0 : elapsed_s(size() - 1); }
  /// Returns the index of the first sample at or after the time `elapsed_s`, or size() after the last sample.
  std::size_t sample_at(double elapsed_s) const;
  /// Signals, then simulated quantities.
  std::vector<Quantity> quantities() const;
  /// Throws device::Error with the list of recorded quantities if the quantity was not recorded.
  const std::vector<float>& column(Quantity quantity) const;
  /// Number of missing samples between the first and the last sample.
  std::uint64_t lost() const;

  /// Returns the end of the gap-free range that contains `begin`, at most `end`.
  std::size_t end_of_stretch(std::size_t begin, std::size_t end) const;
  /// Samples of a range in the format of the scope. Missing periods before the range count as lost.
  device::ScopeSamples samples(std::size_t begin, std::size_t end) const;
  /// Adds samples of information.signals to a recording without simulated columns.
  void append(const device::ScopeSamples& samples);
  /// Deletes the samples before `begin`, the sample at `end` and all later samples.
  void keep(std::size_t begin, std::size_t end);
};

/// Reads an HDF5 or CSV recording; its content determines the format. An incomplete file is read up to its last
/// complete sample. Throws device::Error with a sentence if the file is missing, damaged or not a recording.
Recording read(const std::filesystem::path& file);

}  // namespace inkwell::recording
