#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "firmware/control/signal_path/encoders.hpp"
#include "tests/firmware/control/arms.hpp"

namespace {

using namespace inkwell;
using control::unwrap;

TEST_CASE("a 16-bit timer is followed over its wrap, both ways and many times") {
  std::int32_t unwrapped = 0;
  for (std::int32_t truth = 0; truth < 400'000; truth += 977) {
    unwrapped = unwrap(unwrapped, static_cast<std::uint16_t>(truth));
    CHECK(unwrapped == truth);
  }
  for (std::int32_t truth = unwrapped; truth > -400'000; truth -= 1013) {
    unwrapped = unwrap(unwrapped, static_cast<std::uint16_t>(truth));
    CHECK(unwrapped == truth);
  }
}

TEST_CASE("steps up to half the timer's range are unambiguous") {
  CHECK(unwrap(0, std::uint16_t{32767}) == 32767);
  CHECK(unwrap(0, std::uint16_t{32769}) == -32767);
  CHECK(unwrap(65'535, std::uint16_t{0}) == 65'536);
  CHECK(unwrap(65'536, std::uint16_t{65'535}) == 65'535);
  CHECK(unwrap(-1, std::uint16_t{0}) == 0);
}

TEST_CASE("a 32-bit timer is its own signed number") {
  CHECK(unwrap(0, std::uint32_t{5}) == 5);
  CHECK(unwrap(3, std::uint32_t{0xFFFFFFFE}) == -2);
  CHECK(unwrap(0x7FFFFFFF, std::uint32_t{0x80000000}) == -0x7FFFFFFF - 1);
}

TEST_CASE(
    "more counts in a period than the jump limit are a jump, for any encoder, in both directions and across the wrap") {
  constexpr std::array<std::int32_t, 3> before{0, -70'000, 0x7FFFFFFF - 3};
  for (std::size_t i = 0; i < 3; ++i)
    for (const std::int32_t step : {0, 1, 15, -15, -16, 16, 17, -17, 400, -400, 32'767, -32'768}) {
      CAPTURE(i);
      CAPTURE(step);
      std::array<std::int32_t, 3> now = before;
      now[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(now[i]) + static_cast<std::uint32_t>(step));
      CHECK((control::jumps(before, now, 16) != 0) == (step < -16 || step >= 16));
      CHECK((control::jumps(before, now, 512) != 0) == (step < -512 || step >= 512));
    }
}

TEST_CASE("the jump limit of the encoders is at least 16 counts and at least 100 rad/s for every joint") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  CHECK(control::prepare(set).encoders.jump_counts == 16);
  for (const float counts_per_turn : {4.0f, 4'000.0f, 100'000.0f, 1'000'000.0f}) {
    CAPTURE(counts_per_turn);
    for (std::size_t i = 0; i < 3; ++i) {
      set = tests::omni_parameters();
      set[of_axis(encoder_1_counts_per_turn, i)] = counts_per_turn;
      const control::EncoderScale scale = control::prepare(set).encoders;
      CHECK(std::has_single_bit(scale.jump_counts));
      CHECK(scale.jump_counts >= 16);
      for (const float rad_per_count : scale.rad_per_count)
        CHECK(static_cast<float>(scale.jump_counts) * std::fabs(rad_per_count) * protocol::servo_rate_Hz >= 100.0f);
      CHECK(scale.jump_counts <= std::max(16.0f, 2.0f * 100.0f * protocol::servo_period_s * counts_per_turn *
                                                         set[of_axis(gear_ratio_1, i)] / 6.2831853f +
                                                     1.0f));
    }
  }
}

TEST_CASE("joint angles: the inkwell's angle plus counts by scale, with direction and gear") {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::omni_parameters();
  set[encoder_1_counts_per_turn] = 1440.0f;
  set[gear_ratio_1] = 10.0f;
  set[inkwell_joint_1_rad] = 0.25f;
  set[encoder_2_reversed] = 1.0f;
  set[encoder_2_counts_per_turn] = 2000.0f;
  set[gear_ratio_2] = 5.0f;
  set[inkwell_joint_2_rad] = 0.0f;
  const control::EncoderScale scale = control::prepare(set).encoders;
  const control::Triple joint_rad = control::joint_angles({14'400, 2'500, 0}, scale);
  CHECK(joint_rad[0] == doctest::Approx(0.25 + 6.283185307));
  CHECK(joint_rad[1] == doctest::Approx(-6.283185307 / 4));
  CHECK(joint_rad[2] == set[inkwell_joint_3_rad]);
}

}  // namespace
