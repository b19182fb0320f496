#include "tests/contact/board_trial.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace inkwell::closed_loop {
namespace {

using contact_trial::HollowBody;
using Random = std::mt19937_64;

/// Middle of the workspace.
const glm::dvec3 middle_m{0, 0, -0.03};

double between(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

glm::dvec3 in_cube_m(Random& random, double size_m) {
  return {between(random, -size_m, size_m), between(random, -size_m, size_m), between(random, -size_m, size_m)};
}

glm::dquat any_rotation(Random& random) {
  return glm::normalize(
      glm::dquat{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)});
}

/// A body, and the side of its wall on which the tip is.
struct Place {
  const HollowBody* body;
  bool is_inside;
  double radius_m;  ///< of the tip
  contact::Placement placement;
  glm::dvec3 start_m;  ///< free position of the tip, in the workspace

  /// Distance of a point from the wall, negative beyond the wall.
  double distance_m(const glm::dvec3& position_m) const {
    const glm::dvec3 local_m = placement.to_object(position_m);
    return is_inside ? body->distance_from_inside_m(local_m) : body->distance_from_outside_m(local_m);
  }
  glm::dvec3 any_point_m(Random& random) const { return placement.to_workspace(in_cube_m(random, body->size_m)); }
};

Place find_place(const std::vector<HollowBody>& bodies, Random& random) {
  constexpr double clearance_m = 1e-4;
  Place place{.body = &bodies[random() % bodies.size()],
              .is_inside = random() % 2 == 0,
              .radius_m = between(random, 0.0005, 0.0013),
              .placement = {middle_m, any_rotation(random)},
              .start_m = {}};
  if (!place.is_inside && random() % 2 == 0) place.radius_m = between(random, 0.0005, 0.004);
  do place.start_m = place.any_point_m(random);
  while (place.distance_m(place.start_m) < place.radius_m + clearance_m);
  return place;
}

contact::Material find_material(Wall wall, Random& random) {
  contact::Material material{.stiffness_N_per_m = static_cast<float>(between(random, 200, 1500))};
  if (wall != Wall::frictionless)
    material.static_friction = material.dynamic_friction = static_cast<float>(between(random, 0, 1));
  if (wall == Wall::friction_and_damping) material.damping_Ns_per_m = static_cast<float>(between(random, 0, 2));
  return material;
}

/// Measures the rise of the force.
class RiseMeter {
 public:
  RiseMeter(const ClosedLoop& loop, const contact::Material& material)
      : stiffness_N_per_m_(static_cast<double>(material.stiffness_N_per_m)),
        damping_Ns_per_m_(static_cast<double>(material.damping_Ns_per_m)),
        probe_m_(loop.probe_m()),
        velocity_m_per_s_(loop.velocity_m_per_s()) {}

  /// Returns the rise in the last period of the loop that motion does not explain.
  double measure_N(const ClosedLoop& loop) {
    const glm::dvec3 probe_m = loop.probe_m(), velocity_m_per_s = loop.velocity_m_per_s();
    const double force_N = glm::length(loop.force_N());
    const double change_m_per_s =
        force_N_ == 0 ? glm::length(velocity_m_per_s) : glm::distance(velocity_m_per_s, velocity_m_per_s_);
    const double explained_N =
        late_N_ + stiffness_N_per_m_ * glm::distance(probe_m, probe_m_) + damping_Ns_per_m_ * change_m_per_s;
    const double rise_N = force_N - force_N_ - explained_N;
    const bool is_limited = loop.controller().limits() != 0;
    late_N_ = is_limited ? std::max(-rise_N, 0.0) : 0;
    probe_m_ = probe_m;
    velocity_m_per_s_ = velocity_m_per_s;
    force_N_ = force_N;
    return rise_N;
  }

 private:
  double stiffness_N_per_m_, damping_Ns_per_m_;
  glm::dvec3 probe_m_, velocity_m_per_s_;
  double force_N_ = 0;
  double late_N_ = 0;  ///< explained rise that the limits of the board have delayed
};

}  // namespace

Visit visit(const std::vector<HollowBody>& bodies, std::uint64_t number, double board_s) {
  Random random(number * 0x9E3779B97F4A7C15 + 7);
  Visit visit{.wall = static_cast<Wall>(number % wall_kinds)};
  const Place place = find_place(bodies, random);
  const contact::Material material = find_material(visit.wall, random);
  const double hand_N_per_m = between(random, light_hand.stiffness_N_per_m, firm_hand.stiffness_N_per_m);
  const double hand_s = firm_hand.damping_Ns_per_m / firm_hand.stiffness_N_per_m;
  ClosedLoop loop({.hand = {hand_N_per_m, hand_s * hand_N_per_m, 0},
                   .tip_radius_m = place.radius_m,
                   .start_m = place.start_m,
                   .lost_part = 0.01,
                   .gaps_per_s = 1,
                   .seed = number + 1});
  device::Shapes materials;
  materials.materials = {{material.stiffness_N_per_m, material.damping_Ns_per_m, material.static_friction,
                          material.dynamic_friction, material.viscosity_Ns_per_m}};
  loop.place_shapes(materials);
  auto scene = std::make_shared<contact::Scene>();
  scene->materials[0] = material;
  scene->objects.push_back({.id = 1, .shape = place.body->surface, .placement = place.placement});
  loop.publish(scene);
  loop.run(0.01);

  RiseMeter meter(loop, material);
  glm::dvec3 target_m = place.start_m;
  unsigned until_next = 0;
  unsigned beyond = 0;
  const auto periods = static_cast<unsigned>(board_s * protocol::servo_rate_Hz);
  for (; visit.periods < periods; ++visit.periods) {
    if (until_next == 0) {
      const glm::dvec3 next_m = place.any_point_m(random);
      const double move_s = std::clamp(glm::distance(next_m, target_m) / between(random, 0.05, 0.8), 0.02, 1.0);
      target_m = next_m;
      loop.move_hand(target_m, move_s);
      until_next = static_cast<unsigned>(move_s * between(random, 0.5, 1.2) * protocol::servo_rate_Hz) + 1;
    }
    --until_next;
    loop.run_period();
    const double rise = meter.measure_N(loop);
    visit.largest_rise_N = std::max(visit.largest_rise_N, rise);
    if (rise > rise_N) ++visit.rises;
    if (loop.force_N() != glm::dvec3{}) ++visit.touching_periods;
    const double distance_m = place.distance_m(loop.proxy_m());
    beyond = distance_m < 0 ? beyond + 1 : 0;
    if (beyond > 0) ++visit.beyond_periods;
    visit.longest_beyond_periods = std::max(visit.longest_beyond_periods, beyond);
    visit.deepest_m = std::max(visit.deepest_m, -distance_m);
  }
  visit.models = loop.models_received();
  return visit;
}

}  // namespace inkwell::closed_loop
