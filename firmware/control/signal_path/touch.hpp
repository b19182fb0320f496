// Contact of the tip with all objects: walls, planes, solids and local model.
//
// A proxy is the point of the free space that the tip would have if the objects were rigid (Zilles and Salisbury, "A
// constraint-based god-object method for haptic display", IROS 1995). Near the proxy, each object gives a barrier: a
// tangent plane of its surface. The proxy moves to the point nearest to the probe that no barrier excludes. Spring and
// damper act between proxy and probe. Friction holds the proxy back.
//
// Tangent planes of curved objects are renewed in turn, because a period is too short for all objects. An older tangent
// plane is outside the convex object. A new tangent plane is farther from the proxy, so it does not increase the force.
//
// A new local model does not increase the force: its barriers recede to the proxy, so the previous proxy remains in the
// free space, and the nearest free point is not farther from the probe than the previous proxy.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/contact.hpp"
#include "firmware/control/signal_path/local_model.hpp"
#include "firmware/control/signal_path/shapes.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "firmware/control/signal_path/vector.hpp"

namespace inkwell::control {

/// Excludes the half-space below a tangent plane.
struct Barrier {
  Vector3 normal;  ///< unit vector, points into the free space
  float depth_m;   ///< depth of the probe; negative if the barrier does not exclude the probe
  const Surface* surface;
  const Motion* motion;  ///< of the surface

  void set(const Vector3& normal_, float depth_m_, const Surface& surface_, const Motion& motion_) {
    normal.x = normal_.x;
    normal.y = normal_.y;
    normal.z = normal_.z;
    depth_m = depth_m_;
    surface = &surface_;
    motion = &motion_;
  }
};

/// Depth above which a barrier excludes a point. Rounding errors are smaller.
inline constexpr float depth_tolerance_m = 1e-7f;

/// The barrier that excludes the probe most.
struct Deepest {
  const Barrier* barrier = nullptr;  ///< null if no barrier excludes the probe
  float depth_m = depth_tolerance_m;

  void note(const Barrier& other, float other_depth_m) {
    if (!(other_depth_m > depth_m)) return;
    depth_m = other_depth_m;
    barrier = &other;
  }
};

/// Barriers of one period. If there are more barriers, those that exclude the probe replace the others.
struct Barriers {
  static constexpr std::size_t maximum = 8;

  std::array<Barrier, maximum> list{};
  std::size_t count = 0;
  Barrier* replaced = nullptr;  ///< in a full list, this barrier and all later ones exclude the probe
  Deepest deepest;
  /// A barrier at this distance from the probe may exclude the point to which other barriers push the proxy.
  float reach_m = 0.0f;

  void clear() {
    count = 0;
    replaced = list.data() + maximum;
    deepest = {};
  }
  bool is_in_reach(float depth_m) const { return depth_m > -reach_m; }
  void add(const Vector3& normal, float depth_m, const Surface& surface, const Motion& motion);
  Barrier* end() { return list.data() + count; }
};

/// Barriers that support the nearest free point.
struct Support {
  std::array<const Barrier*, 3> barriers;
  std::array<float, 3> depth_m;
  std::size_t count = 0;
  Vector3 out_m;  ///< from the probe to the nearest free point: the sum of depth times normal

  void add(const Barrier& barrier, float barrier_depth_m) {
    barriers[count] = &barrier;
    depth_m[count++] = barrier_depth_m;
  }
};

/// Finds the point nearest to the probe that no barrier excludes. At least one barrier must exclude the probe. Barriers
/// within 0.2 degrees of parallel count as one barrier.
void find_support(const Barriers& barriers, Support& support);

/// Force on the hand.
struct TouchForce {
  Vector3 walls_N;
  Vector3 objects_N;      ///< shapes and local model
  float raised_J = 0.0f;  ///< work of recessed surfaces that moved outward in this period
};

class Touch {
 public:
  LivingShapes shapes;

  /// Activates a new model with tangent planes. The board changes the model until the next call. A model is used once.
  [[gnu::cold]] void follow(LocalModel& model);
  /// Advances the objects by one period. Returns true if an object has expired.
  bool age();
  /// Returns true if there are shapes or features of a local model.
  bool has_objects() const { return shapes.any() || model_ != nullptr; }

  /// Returns false if the proxy cannot touch a wall. Then `walls` may be null.
  bool can_touch_wall(const Contact& contact) const {
    return barriers_.reach_m > 0.0f || contact.penetration_m != Vector3{};
  }

  /// Runs one period. `walls` is null if the hand does not feel the walls of the box. Without objects, wall_force_N()
  /// returns the same force of the walls in fewer cycles.
  const TouchForce& step(const Vector3& probe_m, const Vector3& velocity_m_per_s, const Box* walls, const Surface& wall,
                         const ForceLimit& limit);
  /// Ends all contacts. Call this function in each period without force and without objects.
  void release(const Vector3& probe_m) {
    proxy_m_ = probe_m;
    touches_ = false;
    rise_part_ = model_rise_part_ = first_rise_part;
    barriers_.reach_m = 0.0f;
  }

  /// Position of the proxy after the last period.
  const Vector3& proxy_m() const { return proxy_m_; }
  /// Sum of the depths of the probe in the surfaces that support the proxy.
  float depth_m() const { return barriers_.reach_m; }
  bool slides() const { return slides_; }

 private:
  bool age_model();
  /// Moves the proxy, which touches a barrier.
  const TouchForce& push(const Vector3& probe_m, const Vector3& velocity_m_per_s, const Surface& wall,
                         const ForceLimit& limit);
  void add_walls(const Vector3& probe_m, const Box& walls, const Surface& wall);
  void add_near_shapes(const Vector3& probe_m, float margin_m);
  void add_model(const Vector3& probe_m);

  LocalModel* model_ = nullptr;
  Feature* renewed_ = nullptr;  ///< feature of the model whose tangent plane was renewed last
  Vector3 proxy_m_;
  bool touches_ = false;
  bool slides_ = false;
  static constexpr float first_rise_part = 0.0625f;  ///< doubles in each period of a touch, up to 1
  /// Part of the largest step of recessed surfaces. In a groove, the proxy moves faster than the surfaces by a factor:
  /// the sum of the depths, divided by the distance from the probe to the proxy. The part is the inverse square of the
  /// factor. A surface that begins to touch moves by the part of the previous period.
  float rise_part_ = first_rise_part;
  /// The same for the local model. Its new surfaces do not move before they touch.
  float model_rise_part_ = first_rise_part;
  // Results of this period are members, because the initialization of local variables takes cycles.
  Barriers barriers_;
  Support support_;
  TouchForce force_;
};

}  // namespace inkwell::control
