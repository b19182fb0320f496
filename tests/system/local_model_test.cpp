// Tests local models of a program on the PC with the flashed image: forces, faults of the program, and latency.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/system/board_rig.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::FeatureKind;
using protocol::ForceSource;
using protocol::Parameter;

constexpr std::uint32_t periods_per_ms = protocol::servo_rate_Hz / 1000;
constexpr device::Material wood{1000, 2, 0.4f, 0.3f, 0};

/// A board with the force on and a hand that pulls the probe into the free space of the box.
struct ModelRig : BoardRig {
  ModelRig() {
    set({{Parameter::force_ramp_s, 0.0f}});
    take_to(free_point_m);
    make_active();
    set({{Parameter::host_timeout_s, 2.0f}});
    device::Shapes shapes;
    shapes.materials = {wood};
    device->place_shapes(shapes);
  }

  /// Advances one millisecond.
  void millisecond() {
    control.run(0.001);
    while (auto pose = device->read_pose(0ms)) seen.push_back(*pose);
  }
  void send(const device::LocalModel& model) {
    device->send_local_model(model, {.mode = protocol::ForceMode::beside_walls});
    millisecond();
  }
  /// Floor at a height above the probe of the rig.
  device::LocalModel floor(double above_m) const {
    device::LocalModel model;
    model.anchor_m = point(0);
    model.features[0] = {.point_m = point(above_m)};
    model.count = 1;
    return model;
  }
  static std::array<float, 3> point(double above_m) {
    return {static_cast<float>(free_point_m[0]), static_cast<float>(free_point_m[1]),
            static_cast<float>(free_point_m[2] + above_m)};
  }

  std::vector<device::Pose> seen;
};

double length(const float (&vector)[3]) { return std::hypot(vector[0], vector[1], vector[2]); }

/// Returns the largest rise of the force between two poses of consecutive milliseconds.
double largest_rise_N(const std::vector<device::Pose>& poses) {
  double largest_N = 0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    largest_N = std::max(largest_N, length(poses[i].force_N) - length(poses[i - 1].force_N));
  return largest_N;
}

TEST_CASE("a local model is felt, its surface rises slowly, and it fades when the program is killed") {
  ModelRig rig;
  for (int i = 0; i < 120; ++i) rig.send(rig.floor(0.002));
  CHECK(protocol::is_felt(rig.seen.back().force_sources, ForceSource::shapes));
  CHECK(rig.seen.back().force_N[2] > 0.5);
  CHECK(std::fabs(rig.seen.back().force_N[0]) < 0.1);
  // 4 mN for each of the 20 periods of a millisecond
  CHECK(largest_rise_N(rig.seen) < 0.1);
  const std::int64_t last_heard = rig.seen.back().time_periods;
  rig.seen.clear();
  for (int i = 0; i < 80; ++i) rig.millisecond();
  const auto gone = std::ranges::find_if(rig.seen, [](const auto& pose) { return length(pose.force_N) == 0; });
  REQUIRE(gone != rig.seen.end());
  CHECK(gone->time_periods - last_heard >= 18 * periods_per_ms);
  CHECK(gone->time_periods - last_heard <= 50 * periods_per_ms);
  CHECK(protocol::force_is_on(rig.seen.back().state));
}

TEST_CASE("contradictory models, lost reports and gaps of 10 ms never make the force step up") {
  ModelRig rig;
  for (int i = 0; i < 600; ++i) {
    device::LocalModel model = rig.floor(0.002);
    if (i % 3 == 1) model = rig.floor(0.006);
    if (i % 7 == 2) model.features[0].direction = {0.6f, 0.0f, 0.8f};
    if (i % 11 == 3) model.features[0] = {.kind = FeatureKind::sphere, .point_m = rig.point(-0.01), .radius_m = 0.015f};
    if (i % 50 >= 40 || i % 13 == 0)
      rig.millisecond();  // the report is lost
    else
      rig.send(model);
  }
  CHECK(largest_rise_N(rig.seen) < 0.2);
  double largest_N = 0;
  for (const auto& pose : rig.seen) largest_N = std::max(largest_N, length(pose.force_N));
  CHECK(largest_N > 0.3);
}

TEST_CASE("stale and malformed local models are refused and counted, and move nothing") {
  ModelRig rig;
  const auto refused = [&rig] { return rig.device->information().report.force_reports_refused; };
  const auto before = refused();
  const device::LocalModel model = rig.floor(0.002);
  const auto old = static_cast<std::uint32_t>(rig.seen.empty() ? 0 : rig.seen.back().sequence) - 200;
  for (int i = 0; i < 5; ++i) {
    rig.device->send_local_model(model, {.pose_sequence = old});
    rig.millisecond();
  }
  device::LocalModel without_material = model;
  without_material.features[0].material = 5;  // the board has one material
  for (int i = 0; i < 5; ++i) rig.send(without_material);
  CHECK(refused() - before == 10);
  CHECK(length(rig.seen.back().force_N) == 0);
}

TEST_CASE("99 % of the models act before the third pose after their pose") {
  ModelRig rig;
  for (int i = 0; i < 10; ++i) rig.millisecond();
  const auto is_felt = [](const device::Pose& pose) {
    return protocol::is_felt(pose.force_sources, ForceSource::shapes);
  };
  int in_time = 0;
  constexpr int models = 100;
  for (int i = 0; i < models; ++i) {
    const auto sequence = rig.seen.back().sequence;
    rig.send(rig.floor(0.002));
    for (int k = 0; k < 5; ++k) rig.millisecond();
    const auto felt =
        std::ranges::find_if(rig.seen, [&](const auto& pose) { return pose.sequence > sequence && is_felt(pose); });
    in_time += felt != rig.seen.end() && felt->sequence <= sequence + 3 ? 1 : 0;
    rig.send({});
    for (int k = 0; k < 5; ++k) rig.millisecond();
    REQUIRE(!is_felt(rig.seen.back()));
  }
  CHECK(in_time * 100 >= 99 * models);
}

}  // namespace
}  // namespace inkwell::tests
