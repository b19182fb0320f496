// One contact step: the proxy of the tip follows the hand and does not pass surfaces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "host/contact/scene.hpp"

namespace inkwell::contact {

/// The tip cannot be smaller than this: a smaller radius, also 0, is felt as this radius. The local model needs a
/// radius because the center of a tip without radius cannot slide around an edge.
inline constexpr double tip_radius_min_m = 0.0005;

/// Distance ahead of the tip in which features are sent to the board: speed times 3 ms, plus 2 mm.
inline constexpr double look_ahead_s = 0.003;
inline constexpr double look_ahead_m = 0.002;

struct Pose {
  glm::dvec3 position_m{};
  glm::dvec3 velocity_m_per_s{};
  glm::dvec3 force_N{};      ///< of the board on the hand, without a limit; 0: not known
  double force_limit_N = 0;  ///< largest force of the board on the hand; 0: no limit
  std::uint32_t sequence = 0;
  double scene_age_s = 0;  ///< time since the placements of the scene were valid
};

/// A surface that the center of the tip cannot pass: the surface of an object, offset by the radius of the tip.
struct Feature {
  enum class Kind : std::uint8_t { plane, cylinder, sphere };
  Kind kind = Kind::plane;
  std::uint32_t id = 0;       ///< a contact keeps its number while it slides over the parts of an object
  glm::vec3 direction{0};     ///< unit vector. Plane: normal; sphere: normal at the proxy; cylinder: axis
  glm::vec3 point_m{0};       ///< plane: point below the proxy; sphere: center; cylinder: point of the axis
  float radius_m = 0;         ///< of cylinder and sphere. Free space is outside
  std::uint8_t material = 0;  ///< index in Scene::materials
  bool moves = false;         ///< with the velocity and spin of the local model
};

inline constexpr std::size_t features_max = 3;
/// Cylinders and spheres with larger radii are sent as their tangent plane.
inline constexpr float feature_radius_max_m = 0.131f;
/// Grid of the anchor. An anchor that rarely changes lets unchanged features encode to unchanged bytes.
inline constexpr float anchor_grid_m = 0.016f;

/// The board renders the features until the next model. The proxy of the PC is in the free space of each feature.
struct LocalModel {
  std::array<Feature, features_max> features{};
  std::size_t count = 0;
  glm::vec3 anchor_m{0};          ///< point of the grid near the proxy
  glm::vec3 velocity_m_per_s{0};  ///< of the moving object at the anchor
  glm::vec3 spin_rad_per_s{0};
  std::uint32_t pose_sequence = 0;
};

/// A touched part of an object.
struct Contact {
  glm::vec3 point_m{0};        ///< on the surface
  glm::vec3 normal{0};         ///< from the surface to the tip
  std::uint32_t object = 0;    ///< Object::id
  std::uint32_t triangle = 0;  ///< number of the face in the source mesh; 0 for solids
  float depth_m = 0;           ///< distance of the hand below the surface that the proxy touches
};

/// State between steps. It stores no scene.
struct Tool {
  double radius_m = tip_radius_min_m;
  bool is_placed = false;  ///< set by the first step. Reset it to place the proxy at the hand
  glm::dvec3 proxy_m{};
  bool slides = false;  ///< the friction is dynamic

  struct TrackedFeature {
    std::uint32_t id, object;
    glm::dvec3 normal, point_m;
  };
  std::array<TrackedFeature, features_max> tracked{};
  std::size_t tracked_count = 0;
  std::uint32_t last_id = 0;

  /// Placements in the previous step.
  struct KnownObject {
    std::uint32_t id = 0;
    const geometry::Surface* surface = nullptr;  ///< only for comparison
    Placement placement;
    /// The tip was in the object when the object appeared, or was squeezed into it. The object is not felt until
    /// the tip has left it.
    bool is_ignored = false;
  };
  std::array<KnownObject, objects_max> known{};
  std::size_t known_count = 0;

  /// A face that limited the last move.
  struct LimitingFace {
    std::uint32_t object, face;
  };
  std::array<LimitingFace, 3> limiting{};
  std::size_t limiting_count = 0;
};

struct Step {
  LocalModel model;
  std::array<Contact, features_max> contacts{};
  std::size_t contact_count = 0;
  glm::dvec3 proxy_m{};
};

/// Moves the proxy toward the hand, and returns the features near the proxy. The path of the proxy keeps the tip's
/// radius from all surfaces, from both sides of a sheet. Loops are bounded: after an unusually long way around edges
/// the proxy continues in the next step. Allocates no memory, and takes no lock.
///
/// A moving object pushes the proxy. If two objects squeeze the tip, the tip enters the moving object, which
/// is then not felt until the tip has left it.
Step step(const Scene& scene, Tool& tool, const Pose& pose);

/// Closest position to `position_m` in the free space of all features: the proxy of an ideal board without friction.
glm::dvec3 project(const LocalModel& model, const glm::dvec3& position_m);

}  // namespace inkwell::contact
