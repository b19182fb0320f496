// Forces and shapes of a user program.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "protocol/reports.hpp"

namespace inkwell::device {

/// protocol::ForceReport describes the effect of this request.
struct ForceRequest {
  std::array<float, 3> force_N{};  ///< on the hand, in workspace axes
  protocol::ForceMode mode = protocol::ForceMode::beside_walls;
  int interval_ms = 1;  ///< time until the next request, 1 to protocol::force_interval_maximum_ms
  /// Sequence number of the pose for which the force was computed. By default, this is the newest pose.
  std::optional<std::uint32_t> pose_sequence{};
};

/// Surface properties of a shape. protocol::SurfaceEntry contains the ranges.
struct Surface {
  float stiffness_N_per_m = 800.0f;
  float damping_Ns_per_m = 2.0f;
  float static_friction = 0.0f;     ///< largest ratio of tangential force to normal force while the probe sticks
  float dynamic_friction = 0.0f;    ///< ratio of tangential force to normal force while the probe slides
  float viscosity_Ns_per_m = 0.0f;  ///< tangential force per tangential speed, at most the normal force
  /// The board removes the shape after this time unless the program places the shape again. By default, the shape
  /// exists while the program drives the arm.
  float life_s = std::numeric_limits<float>::infinity();
};

/// The probe is a point for this wall.
struct Plane {
  std::array<float, 3> point_m{};                 ///< any point on the plane
  std::array<float, 3> normal{0.0f, 0.0f, 1.0f};  ///< points into the free space, with any length except 0
  Surface surface;
};

/// The probe stays outside the sphere.
struct Sphere {
  std::array<float, 3> centre_m{};
  float radius_m = 0.02f;
  Surface surface;
};

/// The probe stays outside the solid. protocol::SolidEntry describes sizes and orientation.
struct Solid {
  protocol::SolidKind kind = protocol::SolidKind::sphere;
  std::array<float, 3> centre_m{};
  std::array<float, 4> orientation{1.0f, 0.0f, 0.0f, 0.0f};  ///< quaternion w, x, y, z
  std::array<float, 3> size_m{0.02f, 0.02f, 0.02f};
  Surface surface;
};

/// Properties of a surface in local models.
using Material = protocol::MaterialEntry;

struct Shapes {
  std::array<std::optional<Plane>, protocol::shape_planes_maximum> planes;
  std::optional<Sphere> sphere;
  std::vector<Solid> solids;        ///< at most protocol::shape_solids_maximum
  std::vector<Material> materials;  ///< at most protocol::materials_maximum; if empty, the board keeps its materials
};

/// Creates the report for the board. Throws Error with the value and its range if the board would refuse the value.
protocol::ForceReport force_report(const ForceRequest& request);
protocol::ShapesReport shapes_report(const Shapes& shapes);

/// Feature of a local model. protocol::FeatureEntry describes the kinds.
struct Feature {
  protocol::FeatureKind kind = protocol::FeatureKind::plane;
  std::array<float, 3> direction{0.0f, 0.0f, 1.0f};  ///< unit vector: normal of a plane, axis of a cylinder
  std::array<float, 3> point_m{};  ///< on the plane, center of the sphere, on the axis of the cylinder
  float radius_m = 0.0f;           ///< of sphere and cylinder
  int material = 0;
  bool moves = false;
};

/// Local model of the objects at the tip. The features are surfaces that the center of the tip cannot pass.
struct LocalModel {
  std::array<Feature, protocol::local_features_maximum> features{};
  std::size_t count = 0;
  std::array<float, 3> anchor_m{};  ///< near the tip; features without change have the same bytes for the same anchor
  std::array<float, 3> velocity_m_per_s{};  ///< of the moving object at the anchor
  std::array<float, 3> spin_rad_per_s{};
  int life_ms = protocol::local_model_life_maximum_ms;
};

/// Creates the report of a local model and of a force. Velocities and forces beyond the range of the report are reduced
/// to the range. Spheres and cylinders that do not fit the report become their tangent planes at the anchor. Throws
/// Error if a value is not finite or if the board would refuse the report.
protocol::LocalModelReport local_model_report(const LocalModel& model, const ForceRequest& force);

}  // namespace inkwell::device
