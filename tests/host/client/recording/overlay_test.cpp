// Tests the alignment of two recordings at the start or at a mark.
#include <doctest/doctest.h>

#include <cmath>

#include "host/client/recording/overlay.hpp"

#include "tests/failure.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::message_of;
using protocol::Signal;

namespace {

/// The value of the only signal is the number of periods since the first sample.
Recording ramp(const std::string& name, std::uint32_t first_period, std::size_t count) {
  Recording recording = Recording::without_samples({.signals = {Signal::force_N}});
  recording.name = name;
  for (std::size_t i = 0; i < count; ++i) {
    recording.periods.push_back(first_period + static_cast<std::uint32_t>(i));
    recording.columns[0].push_back(static_cast<float>(i));
  }
  return recording;
}

}  // namespace

TEST_CASE("a recording is laid over another one from its begin on") {
  const auto base = ramp("base", 1000, 100);
  const Overlay overlay(ramp("over", 777'000, 50), base);
  CHECK(overlay.begins_s() == 0.0);
  const auto values = overlay.compared_with(base.samples(0, 100)).values;
  REQUIRE(values.size() == 100);
  CHECK(values[0] == 0.0f);
  CHECK(values[49] == 49.0f);
  CHECK(std::isnan(values[50]));
  CHECK(overlay.compared_with(base.samples(20, 30)).values.front() == 20.0f);
}

TEST_CASE("two recordings are named after their files, and with their folders if the files have the same name") {
  const auto names = [](const char* one, const char* other) {
    const auto [first, second] = distinct_names(one, other);
    return first + " " + second;
  };
  CHECK(names("/a/soft.h5", "/a/stiff.csv") == "soft stiff");
  CHECK(names("/monday/push.h5", "/tuesday/push.csv") == "monday/push tuesday/push");
  CHECK(names("/monday/arm/push.h5", "/tuesday/arm/push.h5") == "monday/arm/push tuesday/arm/push");
  CHECK(names("/push.h5", "/tuesday/push.h5") == "push tuesday/push");
  CHECK(names("/a/push.h5", "/a/push.csv") == "push.h5 push.csv");
  CHECK(names("/a/push.h5", "/a/../a/push.h5") == "push push");  // the same file
}

TEST_CASE("a mark that both hold aligns them") {
  auto base = ramp("base", 1000, 100);
  auto over = ramp("over", 5000, 100);
  base.marks = {{1030, "touch"}, {1050, "only here"}};
  over.marks = {{5010, "touch"}, {5020, "touch"}, {5030, "only there"}};
  CHECK(common_marks(base, over) == std::vector<std::string>{"touch"});
  const Overlay overlay(over, base, "touch");
  CHECK(overlay.begins_s() == doctest::Approx(20.0 / protocol::servo_rate_Hz));
  const auto values = overlay.compared_with(base.samples(0, 100)).values;
  CHECK(std::isnan(values[19]));
  CHECK(values[20] == 0.0f);
  CHECK(values[30] == 10.0f);
  const auto message = message_of<device::Error>([&] { Overlay(over, base, "only here"); });
  CHECK(message.find("over has no mark `only here`") != std::string::npos);
  CHECK(message.find("`only there`") != std::string::npos);
  // After the recordings are exchanged, the second recording starts first.
  CHECK(Overlay(base, over, "touch").compared_with(over.samples(0, 1)).values[0] == 20.0f);
}

TEST_CASE("an overlay returns only the selected signals") {
  const Recording base = ramp("base", 100, 50), over = ramp("over", 500, 50);
  Overlay overlay(over, base);
  CHECK_FALSE(overlay.select(over.information.signals));
  CHECK(overlay.select({}));
  CHECK(overlay.compared_with(base.samples(0, 10)).values.empty());
  CHECK(overlay.compared_with(base.samples(0, 10)).signals.empty());
}

TEST_CASE("an overlay retains gaps and holds sparse samples until the next sample") {
  const auto base = ramp("base", 0, 100);
  auto gap = ramp("gap", 0, 10);
  gap.periods.back() = 20;
  const auto with_gap = Overlay(gap, base).compared_with(base.samples(0, 30)).values;
  CHECK(with_gap[8] == 8.0f);
  CHECK(std::isnan(with_gap[9]));
  CHECK(std::isnan(with_gap[19]));
  CHECK(with_gap[20] == 9.0f);
  auto sparse = ramp("sparse", 0, 5);
  sparse.information.step_periods = 4;
  for (std::size_t i = 0; i < 5; ++i) sparse.periods[i] = static_cast<std::uint32_t>(4 * i);
  const auto held = Overlay(sparse, base).compared_with(base.samples(0, 30)).values;
  CHECK(held[7] == 1.0f);
  CHECK(held[19] == 4.0f);
  CHECK(std::isnan(held[20]));
  CHECK_THROWS_AS(Overlay(Recording{}, base), device::Error);
}
