#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "firmware/link/program_requests.hpp"

namespace {

using namespace inkwell;
using protocol::ForceMode;
using protocol::ForceReport;
using protocol::RequestResult;
using protocol::ShapesReport;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

ForceReport force(std::uint32_t sequence, float x_N = 1.0f) {
  ForceReport report{};
  report.mode = ForceMode::beside_walls;
  report.interval_ms = 1;
  report.sequence = sequence;
  report.force_N[0] = x_N;
  return report;
}

template <class Report>
std::span<const std::byte> bytes(const Report& report) {
  return std::as_bytes(std::span(&report, 1));
}

std::span<const std::byte> bytes(const ShapesReport& report) {
  return std::as_bytes(std::span(&report, 1))
      .first(protocol::shapes_report_size(report.plane_count, report.solid_count, report.material_count));
}

constexpr protocol::SurfaceEntry valid_surface{800.0f, 1.0f, 0.5f, 0.4f, 3.0f, 2.0f};

ShapesReport one_plane() {
  ShapesReport report{};
  report.plane_count = 1;
  report.planes[0] = {{0.0f, 0.0f, 0.02f}, {0.0f, 0.0f, 4.0f}, valid_surface};
  return report;
}

TEST_CASE("a valid force is returned to the interrupt once") {
  link::ProgramRequests requests;
  CHECK(requests.take_force() == nullptr);
  ForceReport report = force(7, -2.5f);
  report.interval_ms = 4;
  report.mode = ForceMode::instead_of_walls;
  requests.accept_force(bytes(report), true, 0);
  const control::ForceTarget* target = requests.take_force();
  REQUIRE(target != nullptr);
  CHECK(target->force_N == control::Vector3{-2.5f, 0.0f, 0.0f});
  CHECK(target->mode == ForceMode::instead_of_walls);
  CHECK(target->interval_periods == 80);
  CHECK(target->per_interval == doctest::Approx(1.0f / 80));
  CHECK(requests.take_force() == nullptr);
  CHECK(requests.forces_received() == 1);
  CHECK(requests.forces_refused() == 0);
}

TEST_CASE("an invalid force report is counted as refused and is never returned by take_force") {
  const auto broken = [](auto change) {
    ForceReport report = force(1);
    change(report);
    return report;
  };
  const ForceReport reports[] = {
      broken([](auto& report) { report.force_N[0] = not_a_number; }),
      broken([](auto& report) { report.force_N[1] = infinite; }),
      broken([](auto& report) { report.force_N[2] = -infinite; }),
      broken([](auto& report) { report.interval_ms = 0; }),
      broken([](auto& report) { report.interval_ms = protocol::force_interval_maximum_ms + 1; }),
      broken([](auto& report) { report.mode = static_cast<ForceMode>(3); }),
      broken([](auto& report) { report.version = 0; }),
  };
  link::ProgramRequests requests;
  std::uint32_t refused = 0;
  for (const ForceReport& report : reports) {
    CAPTURE(refused);
    requests.accept_force(bytes(report), true, 0);
    CHECK(requests.take_force() == nullptr);
    CHECK(requests.forces_refused() == ++refused);
  }
  for (const std::size_t size : {1u, 27u}) requests.accept_force(bytes(force(1)).first(size), true, 0);
  CHECK(requests.forces_refused() == refused + 2);
  CHECK(requests.forces_received() == refused + 2);
}

TEST_CASE("a huge force stays finite in its square and keeps its direction") {
  ForceReport report = force(1, 3e38f);
  report.force_N[1] = -1.5e38f;
  const auto target = link::decode_force(bytes(report));
  REQUIRE(target);
  CHECK(std::isfinite(control::dot(target->force_N, target->force_N)));
  CHECK(target->force_N.x / target->force_N.y == doctest::Approx(-2.0f));
}

TEST_CASE("a gap in the sequence numbers counts as lost forces, and the start of another program does not") {
  link::ProgramRequests requests;
  const auto accept = [&](std::uint32_t sequence) {
    requests.accept_force(bytes(force(sequence)), true, 0);
    requests.take_force();
  };
  accept(0xFFFFFFFEu);
  accept(0xFFFFFFFFu);
  accept(0);
  CHECK(requests.forces_lost() == 0);
  accept(3);
  CHECK(requests.forces_lost() == 2);
  accept(1'000'000);
  CHECK(requests.forces_lost() == 2);
  ForceReport end = force(1'000'001);
  end.mode = ForceMode::none;
  requests.accept_force(bytes(end), true, 0);
  requests.take_force();
  accept(1'000'005);  // after the mode `none`, any sequence is a new start
  CHECK(requests.forces_lost() == 2);
  requests.accept_force(bytes(force(1'000'006)), true, 0);
  requests.accept_force(bytes(force(1'000'007)), true, 0);  // the interrupt has not accepted the previous force
  CHECK(requests.forces_lost() == 3);
  CHECK(requests.take_force() != nullptr);
}

TEST_CASE("a plane's normal gets the length 1, and its offset is that of its point") {
  control::Shapes shapes;
  link::Materials materials{};
  ShapesReport report = one_plane();
  report.planes[0].point_m[0] = 5.0f;  // any point of the plane
  report.planes[0].normal[0] = 3.0f;
  REQUIRE(link::decode_shapes(bytes(report), shapes, materials));
  CHECK(shapes.planes[0].normal.x == doctest::Approx(0.6f));
  CHECK(shapes.planes[0].normal.z == doctest::Approx(0.8f));
  CHECK(shapes.planes[0].offset_m == doctest::Approx(0.6f * 5.0f + 0.8f * 0.02f));
  CHECK(shapes.surfaces[0].m_per_N == doctest::Approx(1.0f / 800.0f));
  CHECK(shapes.surfaces[0].dynamic_friction == 0.4f);
  CHECK(shapes.surfaces[0].viscosity_Ns_per_m == 3.0f);
  CHECK(shapes.life_periods[0] == 40'001);
  CHECK(shapes.life_periods[1] == 0);
  CHECK(shapes.life_periods[control::Shapes::maximum - 1] == 0);
}

TEST_CASE("a set of shapes is taken whole or refused whole") {
  using Change = void (*)(ShapesReport&);
  static ShapesReport shapes;
  const auto prepare = [](Change change) {
    shapes = one_plane();
    shapes.plane_count = 2;
    shapes.planes[1] = shapes.planes[0];
    shapes.sphere = {{0.0f, 0.0f, 0.0f}, 0.01f, valid_surface};
    shapes.solid_count = 1;
    shapes.solids[0] = {.kind = protocol::SolidKind::box,
                        .orientation = {1, 0, 0, 0},
                        .size_m = {0.01f, 0.01f, 0.01f},
                        .surface = valid_surface};
    shapes.material_count = 1;
    shapes.materials[0] = {800, 1, 0.5f, 0.4f, 0};
    change(shapes);
  };
  static link::ProgramRequests requests;
  prepare([](auto&) {});
  REQUIRE(requests.accept_shapes(bytes(shapes)) == RequestResult::accepted);
  REQUIRE(requests.take_shapes() != nullptr);
  const Change changes[] = {
      [](ShapesReport& report) { report.version = 1; },
      [](ShapesReport& report) { report.planes[1].normal[2] = 0.0f; },
      [](ShapesReport& report) { report.planes[1].normal[0] = not_a_number; },
      [](ShapesReport& report) { report.planes[1].point_m[1] = 11.0f; },
      [](ShapesReport& report) { report.planes[1].surface.stiffness_N_per_m = 0.0f; },
      [](ShapesReport& report) { report.planes[1].surface.stiffness_N_per_m = 3001.0f; },
      [](ShapesReport& report) { report.planes[1].surface.damping_Ns_per_m = -0.1f; },
      [](ShapesReport& report) { report.planes[1].surface.static_friction = 3.5f; },
      [](ShapesReport& report) { report.planes[1].surface.dynamic_friction = 0.6f; },
      [](ShapesReport& report) { report.planes[1].surface.life_s = 11.0f; },
      [](ShapesReport& report) { report.planes[1].surface.life_s = not_a_number; },
      [](ShapesReport& report) { report.sphere.radius_m = 0.0f; },
      [](ShapesReport& report) { report.sphere.centre_m[0] = infinite; },
      [](ShapesReport& report) { report.planes[1].surface.viscosity_Ns_per_m = -1.0f; },
      [](ShapesReport& report) { report.solids[0].kind = static_cast<protocol::SolidKind>(4); },
      [](ShapesReport& report) { report.solids[0].size_m[2] = 0.0004f; },
      [](ShapesReport& report) { report.solids[0].size_m[1] = not_a_number; },
      [](ShapesReport& report) { report.solids[0].orientation[0] = 0.0f; },
      [](ShapesReport& report) { report.solids[0].orientation[1] = not_a_number; },
      [](ShapesReport& report) { report.materials[0].stiffness_N_per_m = 0.0f; },
  };
  std::size_t which = 0;
  for (const Change change : changes) {
    CAPTURE(which++);
    prepare(change);
    CHECK(requests.accept_shapes(bytes(shapes)) == RequestResult::malformed);
    CHECK(requests.take_shapes() == nullptr);
  }
  ShapesReport many = one_plane();
  many.plane_count = protocol::shape_planes_maximum + 1;
  const ShapesReport one = one_plane();
  CHECK(requests.accept_shapes(std::as_bytes(std::span(&many, 1))) == RequestResult::malformed);
  for (const std::size_t size : {protocol::shapes_report_size(1) - 1, std::size_t{4}, std::size_t{0}})
    CHECK(requests.accept_shapes(bytes(one).first(size)) == RequestResult::malformed);
  CHECK(requests.take_shapes() == nullptr);
}

TEST_CASE("shapes are busy while the interrupt has not taken the previous ones, which stay") {
  link::ProgramRequests requests;
  const ShapesReport one = one_plane(), none{};
  REQUIRE(requests.accept_shapes(bytes(one)) == RequestResult::accepted);
  CHECK(requests.accept_shapes(bytes(none)) == RequestResult::busy);
  const control::Shapes* shapes = requests.take_shapes();
  REQUIRE(shapes != nullptr);
  CHECK(shapes->life_periods[0] != 0);
  CHECK(requests.accept_shapes(bytes(none)) == RequestResult::accepted);
}

TEST_CASE("the ticket of shapes is read if the report has this version and contains the ticket") {
  ShapesReport report = one_plane();
  report.ticket = 0x12345678;
  CHECK(link::ticket_of_shapes(bytes(report)) == 0x12345678);
  CHECK(link::ticket_of_shapes(bytes(report).first(11)) == 0);
  CHECK(link::ticket_of_shapes({}) == 0);
  ++report.version;
  CHECK(link::ticket_of_shapes(bytes(report)) == 0);
}

TEST_CASE("a slot without a life may contain any values") {
  ShapesReport report = one_plane();
  report.planes[0].surface = {};
  report.planes[0].normal[0] = not_a_number;
  control::Shapes shapes;
  link::Materials materials{};
  REQUIRE(link::decode_shapes(bytes(report), shapes, materials));
  CHECK(shapes.life_periods[0] == 0);
}

protocol::LocalModelReport local_model(std::uint16_t sequence, std::uint16_t pose_sequence = 0) {
  protocol::LocalModelReport report{};
  report.interval_ms = 1;
  report.life_ms = 20;
  report.sequence = sequence;
  report.pose_sequence = pose_sequence;
  report.feature_count = 1;
  return report;
}

TEST_CASE("local models of the driver arrive, and stale, foreign and malformed ones are refused and counted") {
  link::ProgramRequests requests;
  CHECK(!requests.accept_local_model(bytes(local_model(1)), true, 0));  // there is no material
  ShapesReport materials{};
  materials.material_count = 1;
  materials.materials[0] = {800, 1, 0.5f, 0.4f, 0};
  REQUIRE(requests.accept_shapes(bytes(materials)) == RequestResult::accepted);
  CHECK(requests.accept_local_model(bytes(local_model(2)), true, 0));
  control::LocalModel* model = requests.take_local_model();
  REQUIRE(model != nullptr);
  CHECK(model->count == 1);
  CHECK(model->features[0].surface.stiffness_N_per_m == 800);
  CHECK(requests.take_local_model() == nullptr);
  CHECK(!requests.accept_local_model(bytes(local_model(3)), false, 0));
  // The pose sequence wraps at 65536.
  CHECK(requests.accept_local_model(bytes(local_model(4, 0xFFFF)), true, 0x10000 + 99));
  CHECK(!requests.accept_local_model(bytes(local_model(5, 0xFFFF)), true, 0x10000 + 100));
  CHECK(!requests.accept_local_model(bytes(local_model(6)).first(63), true, 0));
  CHECK(requests.forces_received() == 6);
  CHECK(requests.forces_refused() == 4);
}

TEST_CASE("forces and local models count lost reports together") {
  link::ProgramRequests requests;
  auto without_features = local_model(0xFFFF);
  without_features.feature_count = 0;
  requests.accept_force(bytes(force(0x1FFFE)), true, 0);
  requests.accept_local_model(bytes(without_features), true, 0);
  CHECK(requests.forces_lost() == 1);  // the interrupt has not accepted the force
  requests.take_force();
  without_features.sequence = 2;
  requests.accept_local_model(bytes(without_features), true, 0);
  CHECK(requests.forces_lost() == 3);
}

TEST_CASE("shapes and force end with the driver") {
  link::ProgramRequests requests;
  requests.accept_shapes(bytes(one_plane()));
  SUBCASE("that the interrupt has accepted") { REQUIRE(requests.take_shapes() != nullptr); }
  SUBCASE("that the interrupt has not accepted") {}
  requests.driver_gone();
  const control::Shapes* shapes = requests.take_shapes();
  REQUIRE(shapes != nullptr);
  for (const std::uint32_t periods : shapes->life_periods) CHECK(periods == 0);
  const control::ForceTarget* force = requests.take_force();
  REQUIRE(force != nullptr);
  CHECK(force->mode == ForceMode::none);
}

TEST_CASE("a force of a program that does not drive, or that answers an old pose, is refused") {
  link::ProgramRequests requests;
  ForceReport report = force(1);
  report.pose_sequence = 0xFFFFFFF0u;  // the sequence wraps during the test
  const std::uint32_t oldest = report.pose_sequence + protocol::force_pose_age_maximum_ms;
  CHECK(requests.accept_force(bytes(report), true, oldest));
  requests.take_force();
  CHECK_FALSE(requests.accept_force(bytes(report), true, oldest + 1));
  CHECK_FALSE(requests.accept_force(bytes(report), true, report.pose_sequence - 1));  // from another board
  CHECK_FALSE(requests.accept_force(bytes(report), false, oldest));
  CHECK(requests.take_force() == nullptr);
  CHECK(requests.forces_refused() == 3);
}

TEST_CASE("a shape with an infinite life lasts") {
  ShapesReport report = one_plane();
  report.planes[0].surface.life_s = infinite;
  control::Shapes shapes;
  link::Materials materials{};
  REQUIRE(link::decode_shapes(bytes(report), shapes, materials));
  CHECK(shapes.life_periods[0] == control::Shapes::lasting);
  report.planes[0].surface.life_s = -infinite;
  CHECK_FALSE(link::decode_shapes(bytes(report), shapes, materials));
}

}  // namespace
