// A recording in memory: read back from a file, or as it grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <device/event.hpp>
#include <device/scope_decoder.hpp>
#include <recording/information.hpp>
#include <recording/quantity.hpp>

namespace inkwell::recording {

/// What the user noted, or what happened to the device.
struct Mark {
  std::int64_t period;  ///< control period at which it was set, or it happened
  std::string text;
  device::EventKind kind = device::EventKind::mark;
  std::string clock_utc = {};  ///< as device::clock_utc_now() writes it; empty if it is not known
};

struct Recording {
  std::string name;  ///< of its file, without folder and ending
  Information information;
  bool complete = true;                     ///< false: the program or the disk gave up before the end was written
  std::vector<std::int64_t> periods;        ///< control period of each sample
  std::vector<std::vector<float>> columns;  ///< one for each of information.signals, as long as `periods`
  std::vector<std::vector<float>> simulated_columns;  ///< one for each of information.simulated, as long, too
  std::vector<Mark> marks;                            ///< as read back, in the order of their periods
  std::vector<std::string> remarks;                   ///< sentences about what this version did not understand

  static Recording without_samples(Information information);

  std::size_t size() const { return periods.size(); }
  /// Board time since the first sample.
  double elapsed_s(std::size_t sample) const { return elapsed_s_at(periods[sample]); }
  /// 0 in a recording without samples.
  double elapsed_s_at(std::int64_t period) const {
    return periods.empty() ? 0.0 : device::board_time_s(period - periods.front());
  }
  /// From the first sample to the last; 0 without samples.
  double duration_s() const { return periods.empty() ? 0.0 : elapsed_s(size() - 1); }
  /// The first sample at or after a time since the first sample; size() if there is none.
  std::size_t sample_at(double elapsed_s) const;
  /// Signals first, then what the simulation knew.
  std::vector<Quantity> quantities() const;
  /// Throws device::Error, with what was recorded, if the quantity was not.
  const std::vector<float>& column(Quantity quantity) const;
  /// Samples between the first and the last that are missing.
  std::uint64_t lost() const;

  /// Where the stretch without a gap ends that `begin` lies in; `end` at the latest.
  std::size_t end_of_stretch(std::size_t begin, std::size_t end) const;
  /// A stretch as the scope gave it; periods that are missing before it count as lost.
  device::ScopeSamples samples(std::size_t begin, std::size_t end) const;
  /// The sample as the scope would have given it: its values stay until the next one is due.
  device::ScopeSamples held_sample(std::size_t sample) const;
  /// Adds samples of information.signals to a recording without simulated columns.
  void append(const device::ScopeSamples& samples);
  /// Forgets the samples before `begin` and from `end` on.
  void keep(std::size_t begin, std::size_t end);
};

/// One line for each mark: clock, time since the first sample, kind, text.
std::string log_text(const Recording& recording);

/// Reads an HDF5 or CSV recording, told apart by their content. A file whose end is missing is read as far as
/// it goes. Throws device::Error with a sentence if it is missing, damaged or no recording.
Recording read(const std::filesystem::path& file);

}  // namespace inkwell::recording
