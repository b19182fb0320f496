#include "host/companion/window/scope/signal_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inkwell::window {

namespace {

constexpr int bits_per_level = 4;
constexpr std::size_t branching = std::size_t{1} << bits_per_level;
constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

// Ignores NaN, which represents a lost sample. fmin() and fmax() are slower, because the compiler does not inline these
// functions.
float smaller(float a, float b) { return b < a || a != a ? b : a; }
float larger(float a, float b) { return b > a || a != a ? b : a; }
Extremes merge(Extremes a, Extremes b) { return {smaller(a.minimum, b.minimum), larger(a.maximum, b.maximum)}; }

}  // namespace

SignalSeries::SignalSeries(std::size_t capacity, std::uint64_t first)
    : capacity_(capacity),
      first_(first),
      end_(first),
      lap_(first / capacity * capacity),
      samples_(std::make_unique_for_overwrite<float[]>(capacity)) {
  for (std::size_t blocks = capacity / branching; blocks >= branching; blocks /= branching)
    levels_.push_back({std::make_unique_for_overwrite<Extremes[]>(blocks), blocks});
}

void SignalSeries::append(float value) {
  if (end_ == lap_ + capacity_) lap_ = end_;
  samples_[end_ - lap_] = value;
  ++end_;
  // A complete block contains sixteen blocks of the level below.
  std::uint64_t completed = end_;
  for (std::size_t k = 0; k < levels_.size() && (completed & (branching - 1)) == 0; ++k) {
    const std::uint64_t first = completed - branching;
    Extremes sum{nothing, nothing};
    for (std::uint64_t i = first; i < completed; ++i) {
      if ((i + 1) << (bits_per_level * static_cast<int>(k)) <= first_) continue;  // before the first appended sample
      if (k == 0) {
        const float sample = (*this)[i];
        sum = merge(sum, {sample, sample});
      } else {
        sum = merge(sum, levels_[k - 1].blocks[i % levels_[k - 1].count]);
      }
    }
    completed >>= bits_per_level;
    levels_[k].blocks[(completed - 1) % levels_[k].count] = sum;
  }
}

SignalSeries SignalSeries::with_capacity(std::size_t capacity) const {
  SignalSeries copy(capacity, std::max(begin(), end_ - std::min<std::uint64_t>(end_, capacity)));
  for (std::uint64_t i = copy.first_; i < end_; ++i) copy.append((*this)[i]);
  return copy;
}

Extremes SignalSeries::extremes(std::uint64_t first, std::uint64_t last) const {
  Extremes result{nothing, nothing};
  first = std::max(first, begin());
  last = std::min(last, end_);
  while (first < last) {
    // Selects the largest complete block that starts at `first`.
    std::size_t level = 0;
    int shift = 0;
    while (level < levels_.size() && (first & ((std::uint64_t{branching} << shift) - 1)) == 0 &&
           first + (std::uint64_t{branching} << shift) <= last) {
      shift += bits_per_level;
      ++level;
    }
    if (level == 0) {
      // Reads single samples up to the start of the next block.
      const std::uint64_t stop = std::min(last, (first | (branching - 1)) + 1);
      for (; first < stop; ++first) {
        const float sample = (*this)[first];
        result = merge(result, {sample, sample});
      }
      continue;
    }
    const Level& blocks = levels_[level - 1];
    result = merge(result, blocks.blocks[(first >> shift) % blocks.count]);
    first += std::uint64_t{1} << shift;
  }
  return result;
}

void SignalLane::restart(std::vector<protocol::Signal> signals, std::uint64_t first) {
  signals_ = std::move(signals);
  series_.clear();
  for (std::size_t i = 0; i < signals_.size(); ++i) series_.emplace_back(capacity_, first);
  derived_.clear();
  derive(std::exchange(formulas_, {}));
}

void SignalLane::select(const std::vector<protocol::Signal>& signals) {
  const std::uint64_t next = end();
  std::vector<SignalSeries> series;
  for (const protocol::Signal signal : signals) {
    const auto before = std::ranges::find(signals_, signal);
    if (before == signals_.end())
      series.emplace_back(capacity_, next);
    else
      series.push_back(std::move(series_[static_cast<std::size_t>(before - signals_.begin())]));
  }
  series_ = std::move(series);
  signals_ = signals;
  // Formulas with the same inputs retain their results and filters.
  std::erase_if(derived_, [this](Derived& each) {
    for (std::size_t i = 0; i < each.inputs.size(); ++i) {
      const auto found = std::ranges::find(signals_, each.values.inputs()[i]);
      if (found == signals_.end()) return true;
      each.inputs[i] = static_cast<std::size_t>(found - signals_.begin());
    }
    return false;
  });
  derive(std::exchange(formulas_, {}));
}

void SignalLane::set_capacity(std::size_t capacity) {
  capacity_ = capacity;
  for (SignalSeries& series : series_) series = series.with_capacity(capacity);
  for (Derived& each : derived_) each.series = each.series.with_capacity(capacity);
}

std::uint64_t SignalLane::begin() const {
  const auto oldest = std::ranges::min_element(series_, {}, &SignalSeries::begin);
  return oldest == series_.end() ? 0 : oldest->begin();
}

void SignalLane::derive(const std::vector<ScopeSignal>& formulas) {
  if (formulas == formulas_) return;
  formulas_ = formulas;
  std::erase_if(derived_,
                [&](const Derived& each) { return std::ranges::find(formulas, each.signal) == formulas.end(); });
  for (const ScopeSignal& formula : formulas) {
    if (find(formula) != nullptr) continue;
    auto derived = derived_of(formula);
    if (!derived) continue;
    advance(*derived, end());
    derived_.push_back(std::move(*derived));
  }
}

std::optional<SignalLane::Derived> SignalLane::derived_of(const ScopeSignal& formula) const {
  Derived derived{formula, FormulaValues(*formula.formula()), {}, SignalSeries(capacity_, begin())};
  for (const protocol::Signal input : derived.values.inputs()) {
    const auto found = std::ranges::find(signals_, input);
    if (found == signals_.end()) return std::nullopt;
    derived.inputs.push_back(static_cast<std::size_t>(found - signals_.begin()));
  }
  return derived;
}

void SignalLane::advance(Derived& derived, std::uint64_t until) {
  inputs_.resize(derived.inputs.size());
  for (std::uint64_t at = derived.series.end(); at < until; ++at) {
    for (std::size_t i = 0; i < inputs_.size(); ++i) inputs_[i] = series_[derived.inputs[i]][at];
    derived.series.append(derived.values.next(inputs_));
  }
}

void SignalLane::append(std::span<const float> values) {
  const std::size_t width = signals_.size();
  if (width == 0) return;
  const std::size_t count = values.size() / width;
  for (std::size_t j = 0; j < width; ++j)
    for (std::size_t i = 0; i < count; ++i) series_[j].append(values[i * width + j]);
  for (Derived& each : derived_) advance(each, end());
}

void SignalLane::append_lost(std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i)
    for (auto& series : series_) series.append(nothing);
  for (Derived& each : derived_) advance(each, end());
}

const SignalSeries* SignalLane::find(const ScopeSignal& signal) const {
  if (signal.formula() != nullptr) {
    const auto found = std::ranges::find(derived_, signal, &Derived::signal);
    return found == derived_.end() ? nullptr : &found->series;
  }
  const auto found = std::ranges::find(signals_, signal.of_device());
  return found == signals_.end() ? nullptr : &series_[static_cast<std::size_t>(found - signals_.begin())];
}

void SignalHistory::clear(std::uint64_t first) {
  first_ = first;
  shown_.restart({}, first);
  over_.restart({}, first);
}

void SignalHistory::derive(const std::vector<ScopeSignal>& formulas) {
  shown_.derive(formulas);
  over_.derive(formulas);
  limit_memory();
}

void SignalHistory::limit_memory() {
  constexpr std::size_t step = std::size_t{1} << 16;  // 3 s, so that the capacity rarely changes
  // A sample, and its share of the blocks of 16, 256 and more samples.
  constexpr double sample_bytes = sizeof(float) + static_cast<double>(sizeof(Extremes)) / (branching - 1);
  constexpr auto samples_maximum = static_cast<std::size_t>(memory_maximum_bytes / sample_bytes);
  const std::size_t width = std::max<std::size_t>(1, shown_.width() + over_.width());
  const std::size_t capacity = std::min(capacity_maximum_, std::max(step, samples_maximum / width / step * step));
  if (capacity == capacity_) return;
  capacity_ = capacity;
  shown_.set_capacity(capacity);
  over_.set_capacity(capacity);
}

std::optional<std::uint64_t> SignalHistory::index_of(std::int64_t period) const {
  const std::int64_t index = static_cast<std::int64_t>(end()) - (next_period_ - period);
  return index < 0 || end() == 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(index));
}

std::optional<std::uint64_t> SignalHistory::gap_before(const device::ScopeSamples& samples) const {
  std::uint64_t gap = samples.lost_before;
  if (samples.signals != shown_.signals()) {
    // The number of lost samples before the first samples of a selection is unknown.
    const std::int64_t periods = samples.first_period - next_period_;
    const bool is_continued = std::ranges::any_of(samples.signals, [this](protocol::Signal signal) {
      return shown_.find(signal) != nullptr && shown_.find(signal)->end() > shown_.find(signal)->begin();
    });
    if (periods < 0 || !is_continued) return std::nullopt;
    gap = static_cast<std::uint64_t>(periods);
  }
  return gap > capacity_ ? std::nullopt : std::optional(gap);
}

void SignalHistory::append(const device::ScopeSamples& samples, const device::ScopeSamples* over) {
  if (samples.count == 0) return;
  if (const auto gap = gap_before(samples)) {
    // The gap belongs to the old selection. A signal without samples before the gap starts after the gap.
    shown_.append_lost(*gap);
    over_.append_lost(*gap);
    if (samples.signals != shown_.signals()) shown_.select(samples.signals);
  } else {
    shown_.restart(samples.signals, first_);
    over_.restart({}, std::exchange(first_, 0));
  }
  next_period_ = samples.first_period + static_cast<std::int64_t>(samples.count);
  const std::vector<protocol::Signal> over_signals = over == nullptr ? std::vector<protocol::Signal>{} : over->signals;
  if (over_signals != over_.signals()) over_.restart(over_signals, shown_.end());
  limit_memory();
  shown_.append({samples.values.data(), samples.count * samples.signals.size()});
  if (over != nullptr) over_.append(over->values);
}

std::vector<Extremes> decimate(const SignalSeries& series, double first, double last, std::size_t columns) {
  std::vector<Extremes> result(columns, {nothing, nothing});
  const double width = (last - first) / static_cast<double>(columns);
  // The edges of wide columns are rounded to block boundaries, because reading single samples at the edges would be
  // slow.
  const double grain = width < branching * branching ? 1.0 : branching;
  const auto edge = [&](std::size_t column) {
    const double at = first + width * static_cast<double>(column);
    return std::clamp(grain * std::ceil(at / grain), std::ceil(first), std::ceil(last));
  };
  for (std::size_t i = 0; i < columns; ++i) {
    const double from = edge(i), to = edge(i + 1);
    if (to <= 0.0) continue;
    result[i] = series.extremes(static_cast<std::uint64_t>(std::max(from, 0.0)), static_cast<std::uint64_t>(to));
  }
  return result;
}

}  // namespace inkwell::window
