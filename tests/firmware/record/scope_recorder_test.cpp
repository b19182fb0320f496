#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/firmware/link/fresh_link.hpp"

namespace inkwell {

using protocol::ScopeEncoding;
using protocol::ScopeFrameHeader;
using protocol::Signal;
using protocol::SignalSelection;
using protocol::SignalValues;

namespace {

template <class Value>
Value read(std::span<const std::byte>& bytes) {
  Value value;
  if (bytes.size() < sizeof value) FAIL("the frame ends in the middle of a value");
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes = bytes.subspan(sizeof value);
  return value;
}

float read_value(std::span<const std::byte>& bytes, Signal signal) {
  const protocol::SignalWire wire = protocol::info(signal).wire;
  if (wire == protocol::SignalWire::float32) return read<float>(bytes);
  const float step = wire == protocol::SignalWire::current_int16 ? protocol::current_step_A : protocol::duty_step;
  return static_cast<float>(read<std::int16_t>(bytes)) * step;
}

/// Decodes a frame as documented in protocol/scope.hpp. Calls `sample(period, values)` for every sample.
template <class Sample>
ScopeFrameHeader decode(std::span<const std::byte> frame, const SignalSelection& selection, Sample sample) {
  CHECK(frame.size() <= protocol::scope_frame_maximum);
  const std::size_t size = frame.size();
  const auto header = read<ScopeFrameHeader>(frame);
  CHECK(header.magic == protocol::scope_magic);
  CHECK(header.length == size);
  const protocol::SelectedSignals selected = protocol::selected_signals(selection);
  CHECK(header.signal_count == selected.count);
  std::vector<float> values(selected.count);
  const auto read_group = [&](std::size_t begin, std::size_t end, bool is_first) {
    std::uint32_t mask = 0xFFFF'FFFFu >> (32 - (end - begin));
    if (header.encoding == ScopeEncoding::changes) {
      const std::uint32_t all = mask;
      mask = read<std::uint32_t>(frame);
      CHECK((mask & ~all) == 0);
      if (is_first) CHECK(mask == all);
    }
    for (std::size_t k = begin; k < end; ++k)
      if (mask >> (k - begin) & 1u) values[k] = read_value(frame, static_cast<Signal>(selected.items[k]));
  };
  for (std::uint32_t i = 0; i < header.sample_count; ++i) {
    read_group(0, std::min<std::size_t>(selected.count, 32), i == 0);
    if (selected.count > 32 && i % 16 == 0) read_group(32, selected.count, i == 0);
    sample(header.first_period + i, values);
  }
  CHECK(frame.empty());
  return header;
}

/// Signals with different time courses: constant, stepping, or changing in every period.
SignalValues signals_at(std::uint32_t period) {
  SignalValues signals{};
  for (std::size_t i = 0; i < protocol::signal_count; ++i) {
    const std::uint32_t step = period >> (i % 5 * 3);
    signals.values[i] = static_cast<float>(step % 1000) * 0.001f * (i % 2 ? -1.0f : 1.0f);
  }
  return signals;
}

float resolution(Signal signal) {
  switch (protocol::info(signal).wire) {
    case protocol::SignalWire::current_int16: return 0.51f * protocol::current_step_A;
    case protocol::SignalWire::duty_int16: return 0.51f * protocol::duty_step;
    case protocol::SignalWire::float32: break;
  }
  return 0.0f;
}

SignalSelection select(std::uint8_t count, std::uint8_t first = 0) {
  SignalSelection selection{};
  selection.count = count;
  for (std::uint8_t i = 0; i < count; ++i) selection.signals[i] = static_cast<std::uint8_t>(first + i);
  return selection;
}

/// Records all frames and reads each frame immediately. Every sample must appear exactly once and with correct values.
void check_round_trip(const SignalSelection& selection, ScopeEncoding encoding, std::uint32_t periods) {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  scope.select(selection, 9);
  std::uint32_t next = 500, frames = 0;
  int wrong = 0;
  const auto read_frames = [&] {
    for (auto frame = scope.oldest_frame(); !frame.empty(); frame = scope.oldest_frame()) {
      const auto compare = [&](std::uint32_t period, const std::vector<float>& values) {
        wrong += period != next;
        const SignalValues expected = signals_at(next++);
        for (std::size_t k = 0; k < selection.count; ++k) {
          const auto signal = static_cast<Signal>(selection.signals[k]);
          const float difference = values[k] - expected[signal];
          const float allowed = resolution(signal);
          wrong += !(difference <= allowed && difference >= -allowed);
        }
      };
      const ScopeFrameHeader header = decode(frame, selection, compare);
      CHECK(header.encoding == encoding);
      CHECK(header.sequence == frames++);
      CHECK(header.selection_token == 9);
      CHECK(header.samples_dropped == 0);
      scope.release();
    }
  };
  const std::uint32_t end = 500 + periods;
  for (std::uint32_t period = 500; period < end; ++period) {
    test::record(fresh, signals_at(period), period);
    read_frames();
  }
  scope.select({}, 10);  // finishes the current frame
  for (int i = 0; i < 3; ++i) {
    test::record(fresh, signals_at(0), end);
    read_frames();
  }
  CHECK(wrong == 0);
  CHECK(next == end);
  CHECK(frames > 1);
  CHECK(scope.samples_dropped() == 0);
}

}  // namespace

TEST_CASE("14 floats are sent in full and decoded unchanged") {
  check_round_trip(select(14), ScopeEncoding::full, 300);
}

TEST_CASE("narrow signals between wide ones come back within half a step") {
  SignalSelection selection{};
  selection.count = 7;
  const Signal signals[] = {Signal::current_1_A, Signal::position_x_m, Signal::duty_2,     Signal::current_3_A,
                            Signal::force_N,     Signal::duty_1,       Signal::joint_1_rad};
  for (int i = 0; i < 7; ++i) selection.signals[i] = static_cast<std::uint8_t>(signals[i]);
  check_round_trip(selection, ScopeEncoding::full, 1000);
}

TEST_CASE("the 31 signals of the experiment are sent as changes and decoded unchanged") {
  check_round_trip(select(31), ScopeEncoding::changes, 300);
}

TEST_CASE("32 signals, and the last ones of the table") {
  check_round_trip(select(32, static_cast<std::uint8_t>(protocol::signal_count - 32)), ScopeEncoding::changes, 200);
}

TEST_CASE("a selection of 32 alternating wide and narrow signals can be decoded, with either kind first") {
  for (const std::size_t narrow_remainder : {0u, 1u}) {
    SignalSelection selection = select(32);
    for (std::size_t i = 0; i < 32; ++i)
      selection.signals[i] = static_cast<std::uint8_t>(i % 2 == narrow_remainder ? 25 + i / 2 % 6 : i / 2);
    check_round_trip(selection, ScopeEncoding::changes, 200);
  }
}

TEST_CASE("all signals: the first 32 are sent in each period, and the others in each 16th sample of a frame") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  SignalSelection selection{.count = protocol::selected_by_mask, .signals = {}};
  for (std::size_t i = 0; i < protocol::signal_count; ++i)
    selection.signals[i / 8] = static_cast<std::uint8_t>(selection.signals[i / 8] | 1u << i % 8);
  scope.select(selection, 9);
  constexpr std::uint32_t periods = 400;
  for (std::uint32_t period = 0; period < periods; ++period) test::record(fresh, signals_at(period), period);
  scope.select({}, 10);
  test::record(fresh, {}, periods);
  std::uint32_t next = 0;
  int wrong = 0;
  for (auto frame = scope.oldest_frame(); !frame.empty(); frame = scope.oldest_frame()) {
    const std::uint32_t first = next;
    decode(frame, selection, [&](std::uint32_t period, const std::vector<float>& values) {
      REQUIRE(values.size() == protocol::signal_count);
      wrong += period != next++;
      const SignalValues now = signals_at(period), slow = signals_at(period - (period - first) % 16);
      for (std::size_t k = 0; k < values.size(); ++k) {
        const auto signal = static_cast<Signal>(k);
        const float difference = values[k] - (k < 32 ? now : slow)[signal];
        wrong += !(difference <= resolution(signal) && difference >= -resolution(signal));
      }
    });
    scope.release();
  }
  CHECK(wrong == 0);
  CHECK(next == periods);
  CHECK(link::prepare(selection, 0).encoding == protocol::encoding_for(selection));
}

TEST_CASE("a single signal") { check_round_trip(select(1, 26), ScopeEncoding::full, 3000); }

TEST_CASE("the encoding is the one that the protocol names for a selection") {
  for (std::uint8_t count = 1; count <= 32; ++count) {
    const SignalSelection selection = select(count);
    CHECK(link::prepare(selection, 0).encoding == protocol::encoding_for(selection));
  }
}

TEST_CASE("a narrow value beyond its range saturates") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  const SignalSelection selection = select(1, static_cast<std::uint8_t>(Signal::current_1_A));
  scope.select(selection, 1);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float value : {100.0f, -100.0f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
    SignalValues signals{};
    signals[Signal::current_1_A] = value;
    test::record(fresh, signals, 0);
  }
  scope.select({}, 2);
  test::record(fresh, {}, 5);
  std::vector<float> seen;
  const auto keep = [&](std::uint32_t, const std::vector<float>& values) { seen.push_back(values[0]); };
  decode(scope.oldest_frame(), selection, keep);
  REQUIRE(seen.size() == 5);
  const float highest = 32767.0f * protocol::current_step_A, lowest = -32768.0f * protocol::current_step_A;
  CHECK(seen[0] == highest);
  CHECK(seen[1] == lowest);
  CHECK(seen[2] == highest);
  CHECK(seen[3] == lowest);
  CHECK(seen[4] == lowest);
}

TEST_CASE("without a reader, the recorder drops and counts the oldest frames, but never the frame that is being sent") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  const SignalSelection selection = select(14);
  constexpr std::uint32_t samples_per_frame = protocol::scope_frame_samples_maximum;
  scope.select(selection, 3);
  constexpr std::uint32_t frames_recorded = 100;
  std::uint32_t period = 0;
  for (; period < samples_per_frame; ++period) test::record(fresh, signals_at(period), period);
  REQUIRE(!scope.oldest_frame().empty());  // is being sent from now on
  for (; period < frames_recorded * samples_per_frame; ++period) test::record(fresh, signals_at(period), period);

  const auto first = [&] {
    return decode(scope.oldest_frame(), selection, [](std::uint32_t at, const std::vector<float>& values) {
      if (values[0] != signals_at(at).values[0]) FAIL_CHECK("a sample was overwritten");
    });
  };
  // The recorder retains the newest frames and the frame that is being sent.
  const std::uint32_t kept = link::ScopeFrames::count - 1;
  const std::uint32_t dropped = (frames_recorded - kept) * samples_per_frame;
  CHECK(scope.samples_dropped() == dropped);
  std::uint32_t samples_seen = 0, frames_seen = 0, next_sequence = 0;
  while (!scope.oldest_frame().empty()) {
    const ScopeFrameHeader header = first();
    if (frames_seen == 1) next_sequence = frames_recorded - kept + 1;
    CHECK(header.sequence == next_sequence++);
    CHECK(header.first_period == header.sequence * samples_per_frame);
    samples_seen += header.sample_count;
    ++frames_seen;
    scope.release();
    test::record(fresh, signals_at(period), period);
    ++period;
  }
  CHECK(frames_seen == kept);
  CHECK(samples_seen + dropped == frames_recorded * samples_per_frame);
  CHECK(scope.samples_dropped() == dropped);
}

TEST_CASE("new recordings do not change a frame that is being sent") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  scope.select(select(31), 4);
  std::uint32_t period = 0;
  while (scope.oldest_frame().empty()) test::record(fresh, signals_at(period), period), ++period;
  const auto frame = scope.oldest_frame();
  const std::vector<std::byte> copy(frame.begin(), frame.end());
  for (int i = 0; i < 3000; ++i) test::record(fresh, signals_at(period), period), ++period;
  scope.select(select(5), 5);
  for (int i = 0; i < 3000; ++i) test::record(fresh, signals_at(period), period), ++period;
  CHECK(scope.oldest_frame().data() == frame.data());
  CHECK(std::memcmp(frame.data(), copy.data(), copy.size()) == 0);
}

TEST_CASE("a new selection starts at sequence 0 and discards the samples of the previous selection") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  scope.select(select(14), 1);
  std::uint32_t period = 0;
  for (int i = 0; i < 500; ++i) test::record(fresh, signals_at(period), period), ++period;
  const SignalSelection second = select(3, 6);
  REQUIRE(!scope.oldest_frame().empty());  // is being sent from now on
  scope.select(select(20), 2);             // replaced before the first sample
  scope.select(second, 3);
  const std::uint32_t start = period;
  for (int i = 0; i < 800; ++i) test::record(fresh, signals_at(period), period), ++period;
  // The frame that was being sent is complete, and its token identifies the old selection.
  std::uint32_t old_frames = 0;
  for (;; ++old_frames) {
    ScopeFrameHeader header;
    REQUIRE(!scope.oldest_frame().empty());
    std::memcpy(&header, scope.oldest_frame().data(), sizeof header);
    if (header.selection_token == 3) break;
    CHECK(header.selection_token == 1);
    scope.release();
    test::record(fresh, signals_at(period), period);
    ++period;
  }
  CHECK(old_frames == 1);
  const ScopeFrameHeader header = decode(scope.oldest_frame(), second, [](std::uint32_t, const std::vector<float>&) {});
  CHECK(header.sequence == 0);
  CHECK(header.first_period == start);
  CHECK(scope.samples_dropped() == 0);
}

TEST_CASE("a late main loop loses no samples up to the ring length, and then loses and counts the oldest samples") {
  const SignalSelection selection = select(14);
  for (const std::uint32_t late_periods : {link::SampleRing::readable - 1, link::SampleRing::readable + 25}) {
    link::Link& fresh = test::fresh_link();
    link::ScopeRecorder& scope = fresh.scope;
    scope.select(selection, 1);
    constexpr std::uint32_t before = 10;
    std::uint32_t period = 0;
    for (; period < before; ++period) test::record(fresh, signals_at(period), period);
    for (; period < before + late_periods; ++period) {
      test::interrupt(fresh, signals_at(period), period);
    }
    for (std::uint32_t i = 0; i < 100; ++i, ++period) test::record(fresh, signals_at(period), period);
    scope.select({}, 2);
    // The interrupt has recorded late_periods + 1 samples.
    const std::uint32_t lost = late_periods + 1 - link::SampleRing::readable;
    CHECK(scope.samples_dropped() == lost);
    std::uint32_t next = 0;
    int wrong = 0;
    for (auto frame = scope.oldest_frame(); !frame.empty(); scope.release(), frame = scope.oldest_frame())
      decode(frame, selection, [&](std::uint32_t at, const std::vector<float>& values) {
        if (next == before) next += lost;
        wrong += at != next++ || values[0] != signals_at(at).values[0];
      });
    CHECK(wrong == 0);
    CHECK(next == period);
  }
}

TEST_CASE("each pass of the main loop packs a few samples") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  scope.select(select(14), 1);
  constexpr std::uint32_t samples_per_frame = protocol::scope_frame_samples_maximum, before = samples_per_frame - 26;
  std::uint32_t period = 0;
  for (; period < before; ++period) test::record(fresh, signals_at(period), period);
  for (; period < before + link::SampleRing::readable; ++period) {
    test::interrupt(fresh, signals_at(period), period);
  }
  constexpr std::uint32_t left = samples_per_frame - before, rounds = left / link::ScopeRecorder::samples_per_pack;
  for (std::uint32_t i = 0; i < rounds; ++i) scope.pack();
  CHECK(scope.oldest_frame().empty());
  scope.pack();
  CHECK_FALSE(scope.oldest_frame().empty());
}

TEST_CASE("the scope is off until signals are selected, and after none are") {
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  for (std::uint32_t period = 0; period < 5000; ++period) test::record(fresh, signals_at(period), period);
  CHECK(scope.oldest_frame().empty());
  scope.select(select(2), 1);
  test::record(fresh, signals_at(0), 0);
  scope.select({}, 2);
  test::record(fresh, signals_at(1), 1);
  REQUIRE(!scope.oldest_frame().empty());
  const auto ignore = [](std::uint32_t, const std::vector<float>&) {};
  const ScopeFrameHeader header = decode(scope.oldest_frame(), select(2), ignore);
  CHECK(header.sample_count == 1);
  scope.release();
  for (std::uint32_t period = 0; period < 5000; ++period) test::record(fresh, signals_at(period), period);
  CHECK(scope.oldest_frame().empty());
}

TEST_CASE("a frame of changes stays within its size for any number of changed values at its end") {
  const SignalSelection selection = select(32);
  link::Link& fresh = test::fresh_link();
  link::ScopeRecorder& scope = fresh.scope;
  scope.select(selection, 1);
  SignalValues signals{};
  std::uint32_t random = 1;
  std::uint32_t samples = 0;
  for (std::uint32_t period = 0; period < 20'000; ++period) {
    random = random * 1664525u + 1013904223u;
    const std::size_t changing = random >> 16 & 1u ? 32 : random >> 24 & 15u;
    for (std::size_t k = 0; k < changing; ++k) signals.values[selection.signals[k]] += 0.01f;
    test::record(fresh, signals, period);
    for (auto frame = scope.oldest_frame(); !frame.empty(); frame = scope.oldest_frame()) {
      decode(frame, selection, [&](std::uint32_t, const std::vector<float>&) { ++samples; });
      scope.release();
    }
  }
  CHECK(samples > 19'000);
}

}  // namespace inkwell
