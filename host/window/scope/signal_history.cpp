#include <scope/signal_history.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace inkwell::window {

namespace {

constexpr int bits_per_level = 4;
constexpr std::size_t branching = std::size_t{1} << bits_per_level;
constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

// A NaN, which stands for lost samples, is passed over: a comparison with it is false. Written out because it runs
// for every sample of every plot in every frame, where fmin and fmax would be calls.
float smaller(float a, float b) { return b < a || a != a ? b : a; }
float larger(float a, float b) { return b > a || a != a ? b : a; }
Extremes merge(Extremes a, Extremes b) { return {smaller(a.minimum, b.minimum), larger(a.maximum, b.maximum)}; }

}  // namespace

SignalSeries::SignalSeries(std::size_t capacity)
    : capacity_(capacity), samples_(std::make_unique_for_overwrite<float[]>(capacity)) {
  for (std::size_t blocks = capacity / branching; blocks >= branching; blocks /= branching)
    levels_.push_back({std::make_unique_for_overwrite<Extremes[]>(blocks), blocks - 1});
}

void SignalSeries::append(float value) {
  samples_[end_ & (capacity_ - 1)] = value;
  ++end_;
  // Whenever a block is complete, it is summed up from the sixteen below it.
  std::uint64_t completed = end_;
  for (std::size_t k = 0; k < levels_.size() && (completed & (branching - 1)) == 0; ++k) {
    const std::uint64_t first = completed - branching;
    Extremes sum{nothing, nothing};
    for (std::uint64_t i = first; i < completed; ++i) {
      if (k == 0) {
        const float sample = (*this)[i];
        sum = merge(sum, {sample, sample});
      } else {
        sum = merge(sum, levels_[k - 1].blocks[i & levels_[k - 1].mask]);
      }
    }
    completed >>= bits_per_level;
    levels_[k].blocks[(completed - 1) & levels_[k].mask] = sum;
  }
}

Extremes SignalSeries::extremes(std::uint64_t first, std::uint64_t last) const {
  Extremes result{nothing, nothing};
  first = std::max(first, begin());
  last = std::min(last, end_);
  while (first < last) {
    // Up the levels as far as a whole block starts here and fits.
    std::size_t level = 0;
    int shift = 0;
    while (level < levels_.size() && (first & ((std::uint64_t{branching} << shift) - 1)) == 0 &&
           first + (std::uint64_t{branching} << shift) <= last) {
      shift += bits_per_level;
      ++level;
    }
    if (level == 0) {
      // Samples one by one, to the start of the next block at most.
      const std::uint64_t stop = std::min(last, (first | (branching - 1)) + 1);
      for (; first < stop; ++first) {
        const float sample = (*this)[first];
        result = merge(result, {sample, sample});
      }
      continue;
    }
    const Level& blocks = levels_[level - 1];
    result = merge(result, blocks.blocks[(first >> shift) & blocks.mask]);
    first += std::uint64_t{1} << shift;
  }
  return result;
}

void SignalHistory::clear() {
  signals_.clear();
  series_.clear();
}

void SignalHistory::append(const device::ScopeSamples& samples) {
  if (samples.count == 0) return;
  if (samples.signals != signals_ || samples.lost_before > capacity_) {
    clear();
    signals_ = samples.signals;
    for (std::size_t i = 0; i < signals_.size(); ++i) series_.emplace_back(capacity_);
  } else {
    for (std::uint64_t i = 0; i < samples.lost_before; ++i)
      for (auto& series : series_) series.append(nothing);
  }
  const std::size_t width = signals_.size();
  for (std::size_t j = 0; j < width; ++j)
    for (std::size_t i = 0; i < samples.count; ++i) series_[j].append(samples.values[i * width + j]);
}

const SignalSeries* SignalHistory::find(protocol::Signal signal) const {
  const auto found = std::ranges::find(signals_, signal);
  return found == signals_.end() ? nullptr : &series_[static_cast<std::size_t>(found - signals_.begin())];
}

std::vector<Extremes> decimate(const SignalSeries& series, double first, double last, std::size_t columns) {
  std::vector<Extremes> result(columns, {nothing, nothing});
  const double width = (last - first) / static_cast<double>(columns);
  for (std::size_t i = 0; i < columns; ++i) {
    const double from = std::ceil(first + width * static_cast<double>(i));
    const double to = std::ceil(first + width * static_cast<double>(i + 1));
    if (to <= 0.0) continue;
    result[i] = series.extremes(static_cast<std::uint64_t>(std::max(from, 0.0)), static_cast<std::uint64_t>(to));
  }
  return result;
}

}  // namespace inkwell::window
