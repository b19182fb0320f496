// Control periods of the samples of a recording, stored as stretches without gaps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace inkwell::recording {

/// A recording of one hour has 72 million samples, but only few gaps.
class Stretches {
 public:
  Stretches() = default;
  explicit Stretches(const std::vector<std::int64_t>& periods);

  /// Appends `count` samples without gaps.
  void append(std::int64_t first_period, std::size_t count);

  std::size_t size() const { return size_; }
  std::int64_t period(std::size_t sample) const;
  std::int64_t first_period() const { return stretches_.front().period; }
  std::int64_t last_period() const { return period(size_ - 1); }
  /// Returns the first sample at or after a control period, or size() after the last sample.
  std::size_t sample_at(std::int64_t period) const;
  /// Returns the end of the gap-free range that contains `sample`.
  std::size_t end_of_stretch(std::size_t sample) const;
  /// Number of missing samples between the first and the last sample. `step_periods`: distance of two samples.
  std::uint64_t lost(std::uint32_t step_periods) const;

 private:
  struct Stretch {
    std::size_t sample;   ///< first sample
    std::int64_t period;  ///< control period of the first sample
  };
  std::size_t index_of(std::size_t sample) const;
  std::size_t end_of(std::size_t stretch) const {
    return stretch + 1 < stretches_.size() ? stretches_[stretch + 1].sample : size_;
  }

  std::vector<Stretch> stretches_;
  std::size_t size_ = 0;
};

}  // namespace inkwell::recording
