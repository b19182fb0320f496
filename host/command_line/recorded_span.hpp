// Which of the samples that come belong to a recording of a given length.
#pragma once

#include <cstdint>
#include <optional>

#include <device/device.hpp>

namespace inkwell::command_line {

class RecordedSpan {
 public:
  /// 0 is without end.
  explicit RecordedSpan(std::uint64_t periods) : periods_(periods) {}

  /// Cuts off what lies behind the end. Samples of a time that began anew, as a restarted board's, stay: they are
  /// nearer to no end, and the recorder says what they are.
  void cut(device::ScopeSamples& samples);
  /// Samples up to the end have come, or such as lie behind it.
  bool is_over() const { return is_over_; }
  /// How many periods a recording that is over lacks, if it holds so many samples and counts so many as lost between
  /// them: those are missing at its end.
  std::uint64_t missing_at_end(std::uint64_t samples, std::uint64_t lost) const;

 private:
  std::uint64_t periods_;
  std::uint64_t passed_ = 0;                   ///< from the first sample to the end of the newest
  std::optional<std::int64_t> end_of_newest_;  ///< in the board's own time
  bool is_over_ = false;
};

}  // namespace inkwell::command_line
