#include "host/bindings/library/force_interval.hpp"

#include <algorithm>
#include <utility>

#include "protocol/reports.hpp"

namespace inkwell::library {

int ForceInterval::next(std::uint32_t pose_sequence) {
  static_assert(protocol::pose_rate_Hz == 1000, "a pose is a millisecond");
  const auto before = std::exchange(sequence_before_, pose_sequence);
  const std::uint32_t passed = before ? pose_sequence - *before : 0;
  // Ignores a second force for the same pose. Ignores pauses, because a pause is not a usual interval.
  if (passed >= 1 && passed <= protocol::force_interval_maximum_ms) {
    newest_ms_[oldest_] = static_cast<int>(passed);
    oldest_ = (oldest_ + 1) % newest_ms_.size();
  }
  auto sorted_ms = newest_ms_;
  std::ranges::sort(sorted_ms);
  return sorted_ms[sorted_ms.size() / 2];
}

}  // namespace inkwell::library
