#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "host/client/device/scope_decoder.hpp"

using namespace inkwell;
using protocol::Signal;

namespace {

/// Builds frames byte by byte in the format of the firmware.
struct FrameBuilder {
  protocol::ScopeFrameHeader header{};
  std::vector<std::byte> payload;

  FrameBuilder(std::uint8_t token, std::uint8_t signals, protocol::ScopeEncoding encoding) {
    header.selection_token = token;
    header.signal_count = signals;
    header.encoding = encoding;
  }
  template <class Value>
  FrameBuilder& put(Value value) {
    for (auto byte : std::as_bytes(std::span(&value, 1))) payload.push_back(byte);
    return *this;
  }
  std::vector<std::byte> build(std::uint32_t sequence, std::uint32_t first_period, std::uint16_t samples) {
    header.sequence = sequence;
    header.first_period = first_period;
    header.sample_count = samples;
    header.length = static_cast<std::uint16_t>(sizeof header + payload.size());
    std::vector<std::byte> scope_frame(header.length);
    std::memcpy(scope_frame.data(), &header, sizeof header);
    std::copy(payload.begin(), payload.end(), scope_frame.begin() + sizeof header);
    return scope_frame;
  }
};

constexpr std::uint8_t token = 7;
const std::vector<Signal> few{Signal::position_x_m, Signal::current_1_A, Signal::duty_1};

std::vector<std::byte> full_frame(std::uint32_t sequence, std::uint32_t first_period, int samples = 2) {
  FrameBuilder builder(token, 3, protocol::ScopeEncoding::full);
  for (int i = 0; i < samples; ++i)
    builder.put(0.25f + static_cast<float>(i)).put(std::int16_t{-500}).put(std::int16_t{32767});
  return builder.build(sequence, first_period, static_cast<std::uint16_t>(samples));
}

std::vector<Signal> many() {
  std::vector<Signal> signals;
  for (int i = 0; i < 15; ++i) signals.push_back(static_cast<Signal>(i));  // 60 bytes: too long for `full`
  return signals;
}

FrameBuilder changes_frame() {
  FrameBuilder builder(token, 15, protocol::ScopeEncoding::changes);
  builder.put(std::uint32_t{0x7FFF});
  for (int i = 0; i < 15; ++i) builder.put(static_cast<float>(i));
  return builder;
}

device::ScopeDecoder decoder_for(const std::vector<Signal>& signals) {
  device::ScopeDecoder decoder;
  decoder.expect(token, signals);
  return decoder;
}

}  // namespace

TEST_CASE("the decoder ignores a frame from before its start, even with the same token and a wrapped counter") {
  for (const std::uint32_t begin : {1'000u, 5u}) {
    CAPTURE(begin);
    device::ScopeDecoder decoder;
    decoder.forget_before(begin);
    decoder.expect(token, few);
    CHECK_FALSE(decoder.decode(full_frame(0, begin - 40)));
    const auto samples = decoder.decode(full_frame(1, begin));
    REQUIRE(samples);
    CHECK(samples->first_period == begin);
    CHECK(decoder.malformed_frames() == 0);
  }
}

TEST_CASE("frames are decoded however long ago the device was opened") {
  constexpr std::uint32_t begin = 1'000, quarter = 0x4000'0000;
  device::ScopeDecoder decoder;
  decoder.forget_before(begin);
  SUBCASE("in a selection that lasts for days") {
    decoder.expect(token, few);
    for (std::uint32_t i = 0; i < 6; ++i) CHECK(decoder.decode(full_frame(i, begin + i * quarter)));
  }
  SUBCASE("in a selection that begins days later") {
    for (std::uint32_t i = 0; i < 6; ++i) {
      const std::uint32_t now = begin + i * (quarter + 1'000);
      decoder.pass_time(now);
      decoder.expect(token, few);
      CHECK_FALSE(decoder.decode(full_frame(0, now - 40)));
      if (i > 3) CHECK(decoder.decode(full_frame(0, now)));
    }
  }
  CHECK(decoder.malformed_frames() == 0);
}

TEST_CASE("a full frame gives every signal in its unit") {
  auto decoder = decoder_for(few);
  const auto samples = decoder.decode(full_frame(0, 1000));
  REQUIRE(samples);
  CHECK(samples->first_period == 1000);
  CHECK(samples->count == 2);
  CHECK(samples->lost_before == 0);
  REQUIRE(samples->values.size() == 6);
  CHECK(samples->values[0] == 0.25f);
  CHECK(samples->values[1] == doctest::Approx(-0.1));
  CHECK(samples->values[2] == doctest::Approx(1.0));
  CHECK(samples->values[3] == 1.25f);
}

TEST_CASE("a frame of changes carries the values over that did not change") {
  auto decoder = decoder_for(many());
  auto builder = changes_frame();
  builder.put(std::uint32_t{0}).put(std::uint32_t{1u << 3 | 1u << 14}).put(30.0f).put(140.0f);
  const auto samples = decoder.decode(builder.build(0, 5, 3));
  REQUIRE(samples);
  REQUIRE(samples->values.size() == 45);
  for (std::size_t i = 0; i < 15; ++i) {
    CHECK(samples->values[i] == static_cast<float>(i));
    CHECK(samples->values[15 + i] == static_cast<float>(i));
    CHECK(samples->values[30 + i] == (i == 3 ? 30.0f : i == 14 ? 140.0f : static_cast<float>(i)));
  }
}

TEST_CASE("lost frames are counted in samples, also across the wrap of the period") {
  auto decoder = decoder_for(few);
  REQUIRE(decoder.decode(full_frame(0, 0xFFFF'FFFC)));
  const auto next = decoder.decode(full_frame(1, 0xFFFF'FFFE));
  REQUIRE(next);
  CHECK(next->lost_before == 0);
  const auto later = decoder.decode(full_frame(4, 40));
  REQUIRE(later);
  CHECK(later->lost_before == 40);
  CHECK(decoder.malformed_frames() == 0);
}

TEST_CASE("missing first frames of a selection count as a loss") {
  auto decoder = decoder_for(few);
  const auto samples = decoder.decode(full_frame(3, 1000));
  REQUIRE(samples);
  CHECK(samples->lost_before == 3);
}

TEST_CASE(
    "more than 32 signals: the later ones of the table arrive in each 16th sample, in any order of the selection") {
  constexpr std::size_t count = 40;
  std::vector<Signal> signals;
  for (std::size_t i = 0; i < count; ++i) signals.push_back(static_cast<Signal>(count - 1 - i));
  device::ScopeDecoder decoder;
  decoder.expect(token, signals);
  const auto value_of = [](std::uint32_t sample, std::size_t id) { return static_cast<float>(1000 * sample + id); };
  const auto build = [&](std::uint32_t first_mask, std::uint32_t last_mask) {
    FrameBuilder builder(token, count, protocol::ScopeEncoding::changes);
    for (std::uint32_t sample = 0; sample < 18; ++sample) {
      const auto put = [&](std::size_t id) {
        if (protocol::info(static_cast<Signal>(id)).wire == protocol::SignalWire::float32)
          builder.put(value_of(sample, id));
        else
          builder.put(std::int16_t{0});
      };
      builder.put(sample == 0 ? 0xFFFF'FFFFu : 1u);
      for (std::size_t id = 0; id < (sample == 0 ? 32u : 1u); ++id) put(id);
      if (sample % 16 != 0) continue;
      builder.put(sample == 0 ? first_mask : last_mask);
      for (std::size_t id = 32; id < count; ++id)
        if ((sample == 0 ? first_mask : last_mask) >> (id - 32) & 1u) put(id);
    }
    return builder.build(0, 100, 18);
  };
  const auto samples = decoder.decode(build(0xFF, 0x80));
  REQUIRE(samples);
  REQUIRE(samples->values.size() == 18 * count);
  const auto value = [&](std::uint32_t sample, std::size_t id) {
    return samples->values[sample * count + count - 1 - id];
  };
  CHECK(value(0, 39) == value_of(0, 39));
  CHECK(value(0, 32) == value_of(0, 32));
  CHECK(value(15, 39) == value_of(0, 39));
  CHECK(value(16, 39) == value_of(16, 39));
  CHECK(value(17, 39) == value_of(16, 39));
  CHECK(value(17, 38) == value_of(0, 38));
  CHECK(value(17, 0) == value_of(17, 0));
  CHECK(value(17, 1) == value_of(0, 1));
  CHECK_FALSE(decoder.decode(build(0x7F, 0x80)));   // the first sample has each value
  CHECK_FALSE(decoder.decode(build(0xFF, 0x100)));  // an unselected signal
  CHECK(decoder.malformed_frames() == 2);
}

TEST_CASE("frames of another selection are left out without being an error") {
  auto decoder = decoder_for(few);
  decoder.expect(8, few);
  CHECK_FALSE(decoder.decode(full_frame(0, 0)));
  CHECK(decoder.malformed_frames() == 0);
}

TEST_CASE("a new selection restarts the period count") {
  auto decoder = decoder_for(few);
  REQUIRE(decoder.decode(full_frame(0, 1000)));
  decoder.expect(token, few);
  const auto samples = decoder.decode(full_frame(0, 500));
  REQUIRE(samples);
  CHECK(samples->lost_before == 0);
}

TEST_CASE("no frame is longer than there are, and none belongs to a selection of nothing") {
  auto decoder = decoder_for(few);
  CHECK(decoder.decode(full_frame(0, 1000, 760)));
  CHECK_FALSE(decoder.decode(full_frame(0, 2000, 800)));
  decoder.expect(token, {});
  CHECK_FALSE(decoder.decode(FrameBuilder(token, 0, protocol::ScopeEncoding::full).build(0, 0, 1)));
  CHECK(decoder.malformed_frames() == 2);
}

TEST_CASE("malformed frames are refused, counted, and do not spoil the next one") {
  auto decoder = decoder_for(few);
  REQUIRE(decoder.decode(full_frame(0, 900)));
  auto scope_frame = full_frame(0, 1000);
  const auto damage = [&](std::size_t at, std::uint8_t value) { scope_frame[at] = std::byte{value}; };
  SUBCASE("shorter than its header") { scope_frame.resize(10); }
  SUBCASE("cut off") { scope_frame.resize(scope_frame.size() - 1); }
  SUBCASE("bytes too many") { scope_frame.push_back(std::byte{0}); }
  SUBCASE("wrong magic") { damage(0, 0); }
  SUBCASE("wrong encoding") { damage(offsetof(protocol::ScopeFrameHeader, encoding), 1); }
  SUBCASE("unknown encoding") { damage(offsetof(protocol::ScopeFrameHeader, encoding), 9); }
  SUBCASE("wrong number of signals") { damage(offsetof(protocol::ScopeFrameHeader, signal_count), 4); }
  SUBCASE("more samples than bytes") { damage(offsetof(protocol::ScopeFrameHeader, sample_count), 3); }
  SUBCASE("fewer samples than bytes") { damage(offsetof(protocol::ScopeFrameHeader, sample_count), 1); }
  SUBCASE("no samples") { damage(offsetof(protocol::ScopeFrameHeader, sample_count), 0); }
  CHECK_FALSE(decoder.decode(scope_frame));
  CHECK(decoder.malformed_frames() == 1);
  CHECK(decoder.decode(full_frame(0, 1000)));
}

TEST_CASE("the rest of a frame that was begun for another reader is not malformed") {
  auto decoder = decoder_for(few);
  const auto scope_frame = full_frame(0, 500, 40);
  const std::vector<std::byte> rest(scope_frame.begin() + 64, scope_frame.end());
  SUBCASE("of many bytes") { CHECK_FALSE(decoder.decode(rest)); }
  SUBCASE("shorter than a header") {
    CHECK_FALSE(decoder.decode(std::vector(scope_frame.end() - 10, scope_frame.end())));
  }
  SUBCASE("after whole frames that were left over") {
    decoder.expect(8, {});
    decoder.expect(9, few);
    CHECK_FALSE(decoder.decode(scope_frame));
    CHECK_FALSE(decoder.decode(rest));
  }
  CHECK(decoder.malformed_frames() == 0);
}

TEST_CASE("where no reader was before, or the rest has come, nothing without a header is the rest of a frame") {
  auto decoder = decoder_for(few);
  const auto scope_frame = full_frame(0, 500, 40);
  const std::vector<std::byte> rest(scope_frame.begin() + 64, scope_frame.end());
  SUBCASE("it came") { CHECK_FALSE(decoder.decode(rest)); }
  SUBCASE("a frame came") { REQUIRE(decoder.decode(scope_frame)); }
  SUBCASE("the scope was not given up") {
    REQUIRE(decoder.decode(scope_frame));
    decoder.expect(8, few);
  }
  CHECK(decoder.malformed_frames() == 0);
  CHECK_FALSE(decoder.decode(rest));
  CHECK(decoder.malformed_frames() == 1);
}

TEST_CASE("a frame of changes with an impossible mask is refused") {
  auto decoder = decoder_for(many());
  SUBCASE("a signal that was not selected") {
    auto builder = changes_frame();
    builder.put(std::uint32_t{1u << 15}).put(1.0f);
    CHECK_FALSE(decoder.decode(builder.build(0, 0, 2)));
  }
  SUBCASE("a first sample that is not whole") {
    FrameBuilder builder(token, 15, protocol::ScopeEncoding::changes);
    builder.put(std::uint32_t{1}).put(1.0f);
    CHECK_FALSE(decoder.decode(builder.build(0, 0, 1)));
  }
  CHECK(decoder.malformed_frames() == 1);
}

TEST_CASE("a decreasing period count is refused once and then accepted") {
  auto decoder = decoder_for(few);
  REQUIRE(decoder.decode(full_frame(0, 1000)));
  CHECK_FALSE(decoder.decode(full_frame(1, 500)));
  CHECK(decoder.malformed_frames() == 1);
  const auto next = decoder.decode(full_frame(2, 502));
  REQUIRE(next);
  CHECK(next->lost_before == 0);
}

TEST_CASE("noise never gets through, and never reads beyond its end") {
  auto decoder = decoder_for(many());
  std::mt19937 random(1);
  const auto good = changes_frame().build(0, 0, 1);
  std::uint64_t accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    auto scope_frame = good;
    for (int i = 0; i < 3; ++i) scope_frame[random() % scope_frame.size()] = static_cast<std::byte>(random());
    scope_frame.resize(random() % (scope_frame.size() + 1));
    accepted += decoder.decode(std::vector(scope_frame)).has_value();  // a copy, so that sanitizers see its end
  }
  CHECK(accepted < 400);  // accepted only if the noise changed values alone and the length stayed the same
  CHECK(decoder.malformed_frames() > 15'000);
}
