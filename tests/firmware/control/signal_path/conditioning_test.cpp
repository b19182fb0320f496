#include <doctest/doctest.h>

#include <limits>

#include "firmware/control/signal_path/conditioning.hpp"

namespace {

using namespace inkwell::control;

TEST_CASE("the offsets are the mean of a tenth of a second") {
  CurrentOffsets offsets;
  for (std::uint32_t i = 0; i < CurrentOffsets::duration_periods; ++i) {
    CHECK_FALSE(offsets.measured());
    const float noise = i % 2 == 0 ? 0.01f : -0.01f;
    offsets.measure({0.05f + noise, -0.02f - noise, noise});
  }
  CHECK(offsets.measured());
  CHECK(CurrentOffsets::duration_periods == 2'000);
  CHECK(offsets.offset_A[0] == doctest::Approx(0.05f).scale(0).epsilon(1e-4));
  CHECK(offsets.offset_A[1] == doctest::Approx(-0.02f).scale(0).epsilon(1e-4));
  CHECK(offsets.offset_A[2] == doctest::Approx(0.0f).scale(1).epsilon(1e-5));
  CHECK(offsets.plausible);
}

TEST_CASE("a current offset that is NaN or above the limit is implausible") {
  const auto plausible = [](const Triple& offset_A) {
    CurrentOffsets offsets;
    while (!offsets.measured()) offsets.measure(offset_A);
    return offsets.plausible;
  };
  CHECK_FALSE(plausible({0.0f, -4.1f, 0.0f}));
  CHECK_FALSE(plausible({0.0f, 0.0f, 0.3f}));
  CHECK_FALSE(plausible({std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}));
  CHECK(plausible({0.2f, -0.2f, 0.0f}));
}

TEST_CASE("the supply is filtered, and its reciprocal is ready and finite even without a supply") {
  SupplyFilter filter;
  filter.add_sample(18.0f);
  CHECK(filter.supply_V == 18.0f);
  CHECK(filter.per_V == doctest::Approx(1.0 / 18.0).scale(0).epsilon(1e-6));
  filter.add_sample(12.0f);
  CHECK(filter.supply_V == doctest::Approx(18.0 - 6.0 / 32));
  for (int i = 0; i < 320; ++i) filter.add_sample(0.0f);
  CHECK(filter.supply_V < 0.01f);
  CHECK(filter.per_V == doctest::Approx(1.0));
  filter.add_sample(std::numeric_limits<float>::quiet_NaN());
  filter.add_sample(17.0f);
  CHECK(filter.supply_V == 17.0f);
}

TEST_CASE("switches count after 5 ms without change") {
  SwitchFilter filter;
  std::uint32_t period = 0;
  const auto show = [&](std::uint8_t switches, std::uint32_t periods) {
    for (; periods > 0; --periods, ++period) filter.debounce(switches, period % SwitchFilter::count);
  };
  for (int i = 0; i < 20; ++i) {
    show(1, SwitchFilter::settle_periods - 10);
    show(0, 10);
  }
  CHECK(filter.closed == 0);
  show(5, SwitchFilter::settle_periods - 2);
  CHECK(filter.closed == 0);
  show(5, 5);
  CHECK(filter.closed == 5);
  show(0, 3);
  CHECK(filter.closed == 5);
  for (std::uint32_t later = 0; later < 6; ++later) {
    CAPTURE(later);
    SwitchFilter other;
    for (std::uint32_t i = 0; i < SwitchFilter::settle_periods + later; ++i) other.debounce(1, i % SwitchFilter::count);
    for (std::uint32_t i = 0; i < 2 * SwitchFilter::settle_periods; ++i) other.debounce(0, i % SwitchFilter::count);
    CHECK(other.closed == 0);
  }
  // Each switch has an independent filter.
  for (std::uint32_t i = 0; i <= SwitchFilter::settle_periods; ++i) show(i % 8 < 4 ? 5 : 4, 1);
  CHECK((filter.closed & 4) == 4);
  for (std::uint32_t i = 0; i <= SwitchFilter::settle_periods; ++i) show(i % 8 < 4 ? 1 : 0, 1);
  CHECK((filter.closed & 4) == 0);
}

TEST_CASE("the inkwell sets its reference after the arm has been stationary in it for 0.1 s") {
  InkwellReference reference;
  std::array<std::int32_t, 3> counts{100, -20, 7};
  for (int i = 0; i < 5'000; ++i) CHECK_FALSE(reference.update(counts, false));
  CHECK_FALSE(reference.valid);

  // No reference is recorded while the arm moves with a closed switch.
  for (int i = 0; i < 3'000; ++i) {
    if (i % 1'000 == 0) counts[1] += i == 1'000 ? -2 : 2;
    CHECK_FALSE(reference.update(counts, true));
  }
  // Counts that alternate by one do not prevent a reference.
  int taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    counts[2] = 7 + i % 2;
    if (reference.update(counts, true)) ++taken;
  }
  CHECK(taken == 1);
  CHECK(reference.valid);
  CHECK(reference.counts[0] == 100);
  CHECK(reference.counts[1] == -18);

  // A stylus that is removed, moved and inserted again causes a new reference.
  reference.update(counts, false);
  counts[0] = 104;
  for (std::uint32_t i = 0; i < InkwellReference::still_periods + 2; ++i) reference.update(counts, true);
  CHECK(reference.counts[0] == 104);

  // After forget(), a stylus in the inkwell causes a new reference.
  reference.forget(false);
  CHECK_FALSE(reference.valid);
  for (std::uint32_t i = 0; i < InkwellReference::still_periods; ++i) CHECK_FALSE(reference.update(counts, true));
  CHECK(reference.update(counts, true));
  CHECK(reference.valid);
}

}  // namespace
