#include "host/client/kinematics/velocity.hpp"

#include <algorithm>

namespace inkwell::kinematics {

void VelocityFit::add(double time_s, const std::array<double, 3>& position_m) {
  if (count_ > 0 && time_s < samples_[count_ - 1].time_s) count_ = 0;
  // Removes samples older than the span, and the oldest sample if the array is full.
  const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(count_);
  auto first =
      std::find_if(samples_.begin(), end, [&](const Sample& sample) { return time_s - sample.time_s <= span_s; });
  if (first == samples_.begin() && count_ == capacity) ++first;
  count_ = static_cast<std::size_t>(std::move(first, end, samples_.begin()) - samples_.begin());
  samples_[count_++] = {time_s, position_m};
}

std::array<double, 3> VelocityFit::velocity_m_s() const {
  if (count_ < 2) return {};
  const auto count = static_cast<double>(count_);
  double mean_time_s = 0;
  std::array<double, 3> mean_m{};
  for (std::size_t i = 0; i < count_; ++i) {
    mean_time_s += samples_[i].time_s / count;
    for (std::size_t axis = 0; axis < 3; ++axis) mean_m[axis] += samples_[i].position_m[axis] / count;
  }
  double spread_s2 = 0;
  std::array<double, 3> product{};
  for (std::size_t i = 0; i < count_; ++i) {
    const double time_s = samples_[i].time_s - mean_time_s;
    spread_s2 += time_s * time_s;
    for (std::size_t axis = 0; axis < 3; ++axis)
      product[axis] += time_s * (samples_[i].position_m[axis] - mean_m[axis]);
  }
  if (spread_s2 <= 0) return {};
  for (double& value : product) value /= spread_s2;
  return product;
}

}  // namespace inkwell::kinematics
