#include "host/client/recording/stretches.hpp"

#include <algorithm>

namespace inkwell::recording {

Stretches::Stretches(const std::vector<std::int64_t>& periods) {
  for (const std::int64_t period : periods) append(period, 1);
}

void Stretches::append(std::int64_t first_period, std::size_t count) {
  if (count == 0) return;
  if (stretches_.empty() || first_period != last_period() + 1) stretches_.push_back({size_, first_period});
  size_ += count;
}

std::size_t Stretches::index_of(std::size_t sample) const {
  const auto after = std::ranges::upper_bound(stretches_, sample, {}, &Stretch::sample);
  return static_cast<std::size_t>(after - stretches_.begin()) - 1;
}

std::int64_t Stretches::period(std::size_t sample) const {
  const Stretch& stretch = sample >= stretches_.back().sample ? stretches_.back() : stretches_[index_of(sample)];
  return stretch.period + static_cast<std::int64_t>(sample - stretch.sample);
}

std::size_t Stretches::sample_at(std::int64_t period) const {
  const auto after = std::ranges::upper_bound(stretches_, period, {}, &Stretch::period);
  if (after == stretches_.begin()) return 0;
  const auto index = static_cast<std::size_t>(after - stretches_.begin()) - 1;
  // The same period may begin two stretches of a damaged file; the first of these stretches applies.
  const auto first = static_cast<std::size_t>(
      std::ranges::lower_bound(stretches_, stretches_[index].period, {}, &Stretch::period) - stretches_.begin());
  if (stretches_[first].period == period) return stretches_[first].sample;
  const auto passed = static_cast<std::uint64_t>(period - stretches_[index].period);
  return static_cast<std::size_t>(std::min<std::uint64_t>(stretches_[index].sample + passed, end_of(index)));
}

std::size_t Stretches::end_of_stretch(std::size_t sample) const { return end_of(index_of(sample)); }

std::uint64_t Stretches::lost(std::uint32_t step_periods) const {
  std::int64_t count = 0;
  for (std::size_t i = 1; i < stretches_.size(); ++i) {
    const std::int64_t before = period(stretches_[i].sample - 1);
    count += (stretches_[i].period - before - 1) / std::int64_t{step_periods};
  }
  return static_cast<std::uint64_t>(std::max<std::int64_t>(count, 0));
}

}  // namespace inkwell::recording
