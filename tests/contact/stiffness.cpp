#include "tests/contact/stiffness.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "host/geometry/examples.hpp"
#include "host/geometry/repair.hpp"

namespace inkwell::closed_loop {
namespace {

constexpr double tip_radius_m = 0.005;
constexpr double ball_radius_m = 0.03;
constexpr double plate_m = 0.16;

struct Place {
  glm::dvec3 touched_m;  ///< the center of the tip
  glm::dvec3 normal;
};

Place place_of(const Press& press, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto offset = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const glm::dvec3 touched_m{0.01 * offset(), 0.01 * offset(), -0.03 + 0.01 * offset()};
  if (press.body == Body::plane) return {touched_m, {0, 1, 0}};
  return {touched_m, glm::normalize(glm::dvec3{0.5 * offset(), 1, 0.5 * offset()})};
}

std::shared_ptr<const geometry::Surface> surface_of(const geometry::Mesh& mesh) {
  return geometry::Surface::build(geometry::weld(mesh.vertices_m, mesh.faces));
}

std::array<float, 3> array_of(const glm::dvec3& vector) {
  return {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)};
}

void make_body(ClosedLoop& loop, const Press& press, const Place& place, const device::Surface& surface) {
  if (press.source == Source::board) {
    device::Shapes shapes;
    if (press.body == Body::plane)
      shapes.planes[0] = {array_of(place.touched_m), array_of(place.normal), surface};
    else
      shapes.sphere = {array_of(place.touched_m - place.normal * (ball_radius_m + tip_radius_m)),
                       static_cast<float>(ball_radius_m + tip_radius_m), surface};
    loop.place_shapes(shapes);
    return;
  }
  device::Shapes materials;
  materials.materials = {{surface.stiffness_N_per_m, surface.damping_Ns_per_m, surface.static_friction,
                          surface.dynamic_friction, surface.viscosity_Ns_per_m}};
  loop.place_shapes(materials);
  auto scene = std::make_shared<contact::Scene>();
  contact::Object& object = scene->objects.emplace_back();
  object.id = 1;
  double middle_m = tip_radius_m;  // below the tip
  if (press.body == Body::plane) {
    object.shape = surface_of(geometry::make_box({plate_m, 0.01, plate_m}));
    middle_m += 0.005;
  } else {
    constexpr unsigned subdivisions = 5;
    object.shape = surface_of(geometry::make_ball(ball_radius_m, 0, subdivisions));
    middle_m += ball_radius_m;
  }
  object.placement.position_m = place.touched_m - place.normal * middle_m;
  loop.publish(scene);
}

/// Mean square of the speed.
double square_m2_per_s2(const Press& press, double stiffness_N_per_m, std::uint64_t seed) {
  const Place place = place_of(press, seed);
  constexpr double clearance_m = 0.002;
  ClosedLoop loop({.hand = press.hand,
                   .has_arm_friction = press.has_arm_friction,
                   .tip_radius_m = tip_radius_m,
                   .start_m = place.touched_m + clearance_m * place.normal,
                   .seed = seed});
  make_body(loop, press, place,
            {.stiffness_N_per_m = static_cast<float>(stiffness_N_per_m),
             .damping_Ns_per_m = 1,
             .static_friction = 1,
             .dynamic_friction = 1});
  const double depth_m = press.push_N / press.hand.stiffness_N_per_m + press.push_N / stiffness_N_per_m;
  loop.move_hand(place.touched_m - depth_m * place.normal, 0.3);
  loop.run(1.3);
  constexpr unsigned periods = protocol::servo_rate_Hz / 2;
  double sum_m2_per_s2 = 0;
  for (unsigned count = 0; count < periods; ++count) {
    loop.run_period();
    sum_m2_per_s2 += loop.speed_m_per_s() * loop.speed_m_per_s();
  }
  return sum_m2_per_s2 / periods;
}

}  // namespace

double stiffness_max_N_per_m() {
  return static_cast<double>(info(protocol::Parameter::wall_stiffness_N_per_m).maximum);
}

double rms_speed_m_per_s(const Press& press, double stiffness_N_per_m) {
  double sum_m2_per_s2 = 0;
  for (unsigned seed = 1; seed <= press.trials; ++seed)
    sum_m2_per_s2 += square_m2_per_s2(press, stiffness_N_per_m, seed);
  return std::sqrt(sum_m2_per_s2 / press.trials);
}

// The speed does not rise evenly with the stiffness, because it depends on the encoder steps at the touched point.
// Therefore the result depends on the count of stable contacts, not on the first unstable one.
double stable_stiffness_N_per_m(const Press& press) {
  // A softer surface would let the hand reach the middle of the ball.
  constexpr double first_N_per_m = 75;
  constexpr double factor = 1.1;
  constexpr unsigned unstable_max = 5;
  double stable_N_per_m = first_N_per_m / factor;
  unsigned unstable_in_row = 0;
  for (double next_N_per_m = first_N_per_m; next_N_per_m <= stiffness_max_N_per_m(); next_N_per_m *= factor) {
    const bool is_stable = rms_speed_m_per_s(press, next_N_per_m) <= still_m_per_s;
    unstable_in_row = is_stable ? 0 : unstable_in_row + 1;
    if (is_stable) stable_N_per_m *= factor;
    if (unstable_in_row == unstable_max) break;
  }
  return stable_N_per_m;
}

}  // namespace inkwell::closed_loop
