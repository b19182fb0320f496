#include <doctest/doctest.h>

#include <control/encoders.hpp>
#include <firmware/control/arms.hpp>

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
