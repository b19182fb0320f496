// Overview of a recording: mean and extremes of each block of samples. A plot of a long recording reads the overview
// instead of the samples.
#pragma once

#include <cstddef>
#include <span>

#include "host/client/recording/band.hpp"

namespace inkwell::recording {

inline constexpr std::size_t overview_block_samples = 256;

/// One block, as in the file.
struct OverviewBlock {
  float minimum, maximum, mean;
};
inline constexpr std::size_t overview_block_values = sizeof(OverviewBlock) / sizeof(float);

inline OverviewBlock overview_of(std::span<const float> samples) {
  const Band band = band_of(samples.size(), [&](std::size_t i) { return static_cast<double>(samples[i]); });
  return {static_cast<float>(band.minimum), static_cast<float>(band.maximum), static_cast<float>(band.mean)};
}

}  // namespace inkwell::recording
