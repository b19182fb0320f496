#include "host/companion/command_line/recorded_span.hpp"

#include <algorithm>

namespace inkwell::command_line {

void RecordedSpan::cut(device::ScopeSamples& samples) {
  if (samples.count == 0 || periods_ == 0) return;
  const std::int64_t skipped = samples.first_period - end_of_newest_.value_or(samples.first_period);
  if (skipped < 0) return;
  const std::uint64_t begin = passed_ + static_cast<std::uint64_t>(skipped);
  passed_ = begin + samples.count;
  end_of_newest_ = samples.first_period + static_cast<std::int64_t>(samples.count);
  is_over_ = passed_ >= periods_;
  const std::uint64_t wanted = begin < periods_ ? periods_ - begin : 0;
  samples.count = static_cast<std::size_t>(std::min<std::uint64_t>(samples.count, wanted));
}

std::uint64_t RecordedSpan::missing_at_end(std::uint64_t samples, std::uint64_t lost) const {
  const std::uint64_t held = samples + lost;
  return is_over_ && held < periods_ ? periods_ - held : 0;
}

}  // namespace inkwell::command_line
