// A second recording, aligned with the time of a base recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/client/recording/stored_recording.hpp"

namespace inkwell::recording {

class Overlay {
 public:
  /// Aligns both recordings at the first mark with this text. If the text is empty, aligns the starts of the
  /// recordings. Throws device::Error with a sentence if a recording has no such mark, or no samples.
  Overlay(StoredRecording over, const StoredRecording& base, std::string_view mark = {});

  const StoredRecording& recording() const { return over_; }
  /// Start of the overlaid recording, relative to the first sample of the base.
  double begins_s() const { return static_cast<double>(shift_periods_) / protocol::servo_rate_Hz; }
  /// Selects the signals that compared_with() returns. Signals that were not recorded are omitted. Default: all
  /// signals. Returns true if the selection has changed.
  bool select(const std::vector<protocol::Signal>& shown);
  /// Returns the values at the control periods of the base recording. Missing values are NaN.
  device::ScopeSamples compared_with(const device::ScopeSamples& of_base) const;

 private:
  StoredRecording over_;
  std::vector<protocol::Signal> signals_;
  std::int64_t base_begins_periods_;  ///< first control period of the base
  std::int64_t shift_periods_ = 0;    ///< start of the overlaid recording, in periods of the base
};

/// Returns distinct names for two recordings.
std::pair<std::string, std::string> distinct_names(const std::filesystem::path& one,
                                                   const std::filesystem::path& other);

/// Returns the mark texts that both recordings contain, without duplicates. Common marks can align the recordings.
std::vector<std::string> common_marks(const StoredRecording& a, const StoredRecording& b);

}  // namespace inkwell::recording
