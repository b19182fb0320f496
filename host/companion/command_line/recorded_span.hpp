// Limits a recording to a given length.
#pragma once

#include <cstdint>
#include <optional>

#include "host/client/device/device.hpp"

namespace inkwell::command_line {

class RecordedSpan {
 public:
  /// 0 means no limit.
  explicit RecordedSpan(std::uint64_t periods) : periods_(periods) {}

  /// Removes samples after the end of the recording. Keeps samples after a board restart, but excludes these samples
  /// from the length.
  void cut(device::ScopeSamples& samples);
  /// Returns true if the recording is complete.
  bool is_over() const { return is_over_; }
  /// Returns the number of control periods that are missing at the end. `samples` and `lost` are the numbers of stored
  /// and lost samples.
  std::uint64_t missing_at_end(std::uint64_t samples, std::uint64_t lost) const;

 private:
  std::uint64_t periods_;
  std::uint64_t passed_ = 0;                   ///< from the first sample to the end of the newest samples
  std::optional<std::int64_t> end_of_newest_;  ///< in board time
  bool is_over_ = false;
};

}  // namespace inkwell::command_line
