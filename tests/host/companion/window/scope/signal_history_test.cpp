// Tests the extremes of ranges in the scope's history, before and after old samples are overwritten.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "host/companion/window/scope/signal_history.hpp"

using namespace inkwell;
using window::Extremes;
using window::SignalSeries;

namespace {

Extremes extremes_one_by_one(const SignalSeries& series, std::uint64_t first, std::uint64_t last) {
  Extremes result{std::nanf(""), std::nanf("")};
  for (std::uint64_t i = std::max(first, series.begin()); i < std::min(last, series.end()); ++i)
    result = {std::fmin(result.minimum, series[i]), std::fmax(result.maximum, series[i])};
  return result;
}

bool equal(Extremes a, Extremes b) {
  if (std::isnan(a.minimum) || std::isnan(b.minimum)) return std::isnan(a.minimum) && std::isnan(b.minimum);
  return a.minimum == b.minimum && a.maximum == b.maximum;
}

device::ScopeSamples samples_of(std::vector<protocol::Signal> signals, std::uint32_t first_period, std::size_t count,
                                float value) {
  device::ScopeSamples samples{std::move(signals), first_period, count, {}, 0};
  samples.values.assign(count * samples.signals.size(), value);
  return samples;
}

}  // namespace

TEST_CASE("the extremes of random stretches are those of their samples") {
  SignalSeries series(4096);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0f, 1.0f);
  // The samples exceed twice the capacity, so that every level is overwritten.
  for (int i = 0; i < 10'000; ++i) series.append(i % 997 == 0 ? std::nanf("") : noise(random));
  CHECK(series.begin() == 10'000 - 4096);
  std::uniform_int_distribution<std::uint64_t> index(5000, 10'100);
  for (int i = 0; i < 500; ++i) {
    const std::uint64_t a = index(random);
    const std::uint64_t b = index(random);
    CAPTURE(a);
    CAPTURE(b);
    CHECK(equal(series.extremes(std::min(a, b), std::max(a, b)),
                extremes_one_by_one(series, std::min(a, b), std::max(a, b))));
  }
}

TEST_CASE("one spike among a million samples is visible in its column only") {
  SignalSeries series(std::size_t{1} << 20);
  constexpr std::uint64_t spike = 777'777;
  for (std::uint64_t i = 0; i < 1'000'000; ++i) series.append(i == spike ? 5.0f : 0.0f);
  const auto columns = window::decimate(series, 0.0, 1'000'000.0, 800);
  REQUIRE(columns.size() == 800);
  for (std::size_t i = 0; i < columns.size(); ++i) CHECK(columns[i].maximum == (i == spike / 1250 ? 5.0f : 0.0f));
}

TEST_CASE("each sample belongs to exactly one column, and no sample outside the interval is included") {
  constexpr std::uint64_t first = 1003, last = 402'011;
  SignalSeries series(std::size_t{1} << 20);
  for (std::uint64_t i = 0; i < 500'000; ++i)
    series.append(i < first || i >= last ? 1e6f : i % 3001 == 0 ? static_cast<float>(i / 3001) : 0.0f);
  const auto columns = window::decimate(series, first, last, 300);
  int spikes = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    CHECK(columns[i].maximum < 1e6f);
    if (columns[i].maximum == 0.0f) continue;
    ++spikes;
    const double at = 3001.0 * static_cast<double>(columns[i].maximum);
    const double width = static_cast<double>(last - first) / static_cast<double>(columns.size());
    CHECK(std::abs((at - static_cast<double>(first)) / width - static_cast<double>(i) - 0.5) < 0.52);
  }
  CHECK(spikes == 133);
}

TEST_CASE("columns before the first sample and after the last one are empty") {
  SignalSeries series(256);
  for (int i = 0; i < 100; ++i) series.append(1.0f);
  const auto columns = window::decimate(series, -100.0, 200.0, 3);
  CHECK(std::isnan(columns[0].minimum));
  CHECK(columns[1].maximum == 1.0f);
  CHECK(std::isnan(columns[2].minimum));
}

TEST_CASE("the history marks lost samples, and restarts after a change to other signals") {
  using protocol::Signal;
  window::SignalHistory history(1024);
  history.append(samples_of({Signal::force_N, Signal::duty_1}, 5000, 10, 2.0f));
  auto after_loss = samples_of({Signal::force_N, Signal::duty_1}, 5014, 10, 3.0f);
  after_loss.lost_before = 4;
  history.append(after_loss);
  REQUIRE(history.end() == 24);
  const SignalSeries& force = *history.find(Signal::force_N);
  CHECK(force[9] == 2.0f);
  CHECK(std::isnan(force[10]));
  CHECK(std::isnan(force[13]));
  CHECK(force[14] == 3.0f);

  history.append(samples_of({Signal::supply_V}, 9000, 5, 1.0f));
  CHECK(history.end() == 5);
  CHECK(history.find(Signal::duty_1) == nullptr);
}

TEST_CASE("a signal in both selections retains its samples, and a new signal has a gap before its first sample") {
  using protocol::Signal;
  window::SignalHistory history(1024);
  const window::ScopeSignal doubled(window::Formula{"doubled_N", "2 * force_N", "N"});
  history.derive({doubled});
  history.append(samples_of({Signal::force_N, Signal::duty_1}, 5000, 100, 2.0f));
  history.append(samples_of({Signal::supply_V, Signal::force_N}, 5130, 50, 3.0f));
  REQUIRE(history.end() == 180);
  CHECK(history.begin() == 0);
  const SignalSeries& force = *history.find(Signal::force_N);
  CHECK(force[0] == 2.0f);
  CHECK(force[99] == 2.0f);
  CHECK(std::isnan(force[100]));
  CHECK(std::isnan(force[129]));
  CHECK(force[130] == 3.0f);
  CHECK(history.find(Signal::duty_1) == nullptr);
  const SignalSeries& supply = *history.find(Signal::supply_V);
  CHECK(std::isnan(supply[50]));
  CHECK(supply[130] == 3.0f);
  CHECK(std::isnan(supply.extremes(0, 130).maximum));
  REQUIRE(history.find(doubled) != nullptr);
  CHECK((*history.find(doubled))[50] == 4.0f);
  CHECK((*history.find(doubled))[150] == 6.0f);
}

TEST_CASE("a restart of the board clears the history, also with a change of the selection") {
  using protocol::Signal;
  window::SignalHistory history(1024);
  history.append(samples_of({Signal::force_N, Signal::duty_1}, 5000, 100, 2.0f));
  history.append(samples_of({Signal::force_N}, 200, 50, 3.0f));
  CHECK(history.end() == 50);
  CHECK((*history.find(Signal::force_N))[0] == 3.0f);
}

TEST_CASE("many signals have a shorter history, so that the memory is limited, and retain their newest samples") {
  using protocol::Signal;
  window::SignalHistory history;
  const std::size_t capacity_of_few = history.capacity();
  CHECK(capacity_of_few > 100 * 20'000);
  std::vector<Signal> few{Signal::force_N}, many;
  for (std::size_t i = 0; i < 32; ++i) many.push_back(static_cast<Signal>(i));
  history.append(samples_of(few, 0, 10, 1.0f));
  CHECK(history.capacity() == capacity_of_few);
  auto over = samples_of(many, 10, 1, 4.0f);
  history.append(samples_of(many, 10, 1, 3.0f), &over);
  const std::size_t samples = history.capacity() * 2 * many.size();
  CHECK(samples * sizeof(float) < window::SignalHistory::memory_maximum_bytes);
  CHECK(samples * sizeof(float) > window::SignalHistory::memory_maximum_bytes / 2);
  CHECK((*history.find(Signal::force_N))[9] == 1.0f);
  CHECK((*history.find(Signal::force_N))[10] == 3.0f);
  history.append(samples_of(few, 11, 1, 5.0f));
  CHECK(history.capacity() == capacity_of_few);
  CHECK((*history.find(Signal::force_N))[9] == 1.0f);
}

TEST_CASE("a series of any capacity holds the extremes of its newest samples") {
  for (const std::size_t capacity : {std::size_t{16}, std::size_t{100}, std::size_t{4095}, std::size_t{65'536}}) {
    CAPTURE(capacity);
    SignalSeries series(capacity);
    const auto value = [](std::uint64_t i) { return static_cast<float>(i * 2'654'435'761u % 1000); };
    for (std::uint64_t i = 0; i < 70'001; ++i) series.append(value(i));
    for (const SignalSeries& each : {series.with_capacity(capacity), series.with_capacity(capacity / 2 + 8)}) {
      std::size_t wrong = 0;
      for (std::uint64_t first = each.begin(); first < each.end(); first += 1 + capacity / 7)
        for (std::uint64_t last = first + 1; last <= each.end(); last += 1 + capacity / 5) {
          float least = value(first), largest = least;
          for (std::uint64_t i = first; i < last; ++i) {
            least = std::min(least, value(i));
            largest = std::max(largest, value(i));
            wrong += each[i] != value(i);
          }
          wrong += each.extremes(first, last).minimum != least || each.extremes(first, last).maximum != largest;
        }
      CHECK(wrong == 0);
      CHECK(each.end() - each.begin() <= capacity);
    }
  }
}
