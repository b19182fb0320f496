// Functions of the C interface for objects that the hand can feel.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "host/feel/materials.hpp"

#include "host/bindings/library/c_guard.hpp"
#include "host/bindings/library/growing_struct.hpp"
#include "host/bindings/library/mesh_arrays.hpp"

using namespace inkwell::library;
namespace contact = inkwell::contact;
namespace feel = inkwell::feel;
namespace protocol = inkwell::protocol;

namespace {

// Programs contain these layouts. New members are appended.
static_assert(offsetof(inkwell_object, material) == 184 && offsetof(inkwell_object, is_smooth) == 224);
static_assert(offsetof(inkwell_contact, time_s) == 64 && sizeof(inkwell_contact) == 72);
static_assert(offsetof(inkwell_event, contact) == 16 && sizeof(inkwell_event) == 88);
static_assert(INKWELL_OBJECTS_MAXIMUM == contact::objects_max && INKWELL_MATERIALS_MAXIMUM == contact::materials_max);
static_assert(INKWELL_CONTACTS_MAXIMUM == contact::features_max);
static_assert(INKWELL_TOUCHED == static_cast<int>(feel::Event::Kind::touched) &&
              INKWELL_LEFT == static_cast<int>(feel::Event::Kind::left) &&
              INKWELL_PRESSED == static_cast<int>(feel::Event::Kind::pressed) &&
              INKWELL_RELEASED == static_cast<int>(feel::Event::Kind::released));

/// Faster objects are errors of the program. A local model can contain these values.
constexpr double speed_maximum_m_per_s = 6, spin_maximum_rad_per_s = 30;
static_assert(speed_maximum_m_per_s <= double{protocol::local_speed_step_m_per_s} * INT16_MAX);
static_assert(spin_maximum_rad_per_s <= double{protocol::local_spin_step_rad_per_s} * INT8_MAX);

glm::dvec3 vector_of(const double (&values)[3], double maximum, const char* what, const char* unit) {
  for (const double value : values)
    if (!(std::abs(value) <= maximum))
      throw BadArgument(
          fmt::format("{} is {}{}. Give a number from {} to {}{}.", what, value, unit, -maximum, maximum, unit));
  return {values[0], values[1], values[2]};
}

contact::Placement placement_of(const inkwell_placement& placement) {
  const auto& [x, y, z, w] = placement.quaternion;
  const glm::dvec3 position_m =
      vector_of(placement.position_m, protocol::shape_distance_maximum_m, "A coordinate of the object", " m");
  if (x == 0 && y == 0 && z == 0 && w == 0) return {position_m, {1, 0, 0, 0}};
  const glm::dquat rotation(w, x, y, z);
  const double length = glm::length(rotation);
  if (!(length > 0.1 && length < 10))
    throw BadArgument("The quaternion of the object is not a rotation. Give x, y, z, w of length 1.");
  return {position_m, rotation / length};
}

struct ObjectMotion {
  glm::dvec3 velocity_m_per_s, spin_rad_per_s;
};

ObjectMotion motion_of(const inkwell_placement& placement) {
  return {vector_of(placement.velocity_m_per_s, speed_maximum_m_per_s, "A velocity of the object", " m/s"),
          vector_of(placement.angular_velocity_rad_per_s, spin_maximum_rad_per_s, "An angular velocity of the object",
                    " rad/s")};
}

contact::Material material_of(const inkwell_material& material) {
  return {material.stiffness_N_per_m == 0 ? contact::Material{}.stiffness_N_per_m
                                          : static_cast<float>(material.stiffness_N_per_m),
          static_cast<float>(material.damping_Ns_per_m), static_cast<float>(material.static_friction),
          static_cast<float>(material.dynamic_friction), static_cast<float>(material.viscosity_Ns_per_m)};
}

double length_of(double length_m) {
  constexpr double minimum_m = 1e-6, maximum_m = protocol::shape_distance_maximum_m;
  if (!(length_m >= minimum_m && length_m <= maximum_m))
    throw BadArgument(
        fmt::format("A size of the object is {} m. Give a number from {} to {} m.", length_m, minimum_m, maximum_m));
  return length_m;
}

contact::Shape shape_of(const inkwell_object& object) {
  const auto length_m = [&](std::size_t index) { return length_of(object.size_m[index]); };
  switch (object.shape) {
    case INKWELL_SHAPE_SPHERE: return contact::Sphere{length_m(0)};
    case INKWELL_SHAPE_CAPSULE: return contact::Capsule{length_m(0), length_m(1)};
    case INKWELL_SHAPE_CYLINDER: return contact::Cylinder{length_m(0), length_m(1)};
    case INKWELL_SHAPE_BOX: return contact::Box{{length_m(0), length_m(1), length_m(2)}};
    case INKWELL_SHAPE_MESH: return surface_of_arrays(object.mesh);
    case INKWELL_SHAPE_HALF_SPACE: return contact::Plane{};
  }
  throw BadArgument(fmt::format("{} is not a shape. Give one of inkwell_shape.", static_cast<int>(object.shape)));
}

void put(const glm::vec3& from, double (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<double>(from[axis]);
}

inkwell_contact contact_of(const contact::Contact& from, double time_s) {
  inkwell_contact to{};
  to.object = from.object;
  to.triangle = from.triangle;
  put(from.point_m, to.point_m);
  put(from.normal, to.normal);
  to.depth_m = static_cast<double>(from.depth_m);
  to.time_s = time_s;
  return to;
}

}  // namespace

inkwell_result inkwell_find_material(const char* name, inkwell_material* material) {
  return guarded([&] {
    required(material, "The pointer to the material");
    const auto* const found = feel::find_material(required(name, "The name"));
    if (found == nullptr)
      throw BadArgument(
          fmt::format("The material {} does not exist. Give one of these: {}.", name, feel::material_names()));
    const contact::Material& properties = found->properties;
    *material = {static_cast<double>(properties.stiffness_N_per_m), static_cast<double>(properties.damping_Ns_per_m),
                 static_cast<double>(properties.static_friction), static_cast<double>(properties.dynamic_friction),
                 static_cast<double>(properties.viscosity_Ns_per_m)};
  });
}

inkwell_result inkwell_scene_add(inkwell_arm* arm, const inkwell_object* given, size_t size, uint32_t* number) {
  return guarded([&] {
    required(given, "The pointer to the object");
    required(number, "The pointer to the number");
    check_size(size, sizeof(inkwell_object), "inkwell_object");
    Arm& opened = arm_of(arm);
    const ObjectMotion motion = motion_of(given->placement);
    contact::Object object;
    object.placement = placement_of(given->placement);
    object.velocity_m_per_s = motion.velocity_m_per_s;
    object.spin_rad_per_s = motion.spin_rad_per_s;
    object.is_smooth = given->is_smooth != 0;
    object.shape = shape_of(*given);
    *number = opened.add_object(std::move(object), material_of(given->material));
  });
}

inkwell_result inkwell_scene_move(inkwell_arm* arm, uint32_t number, const inkwell_placement* placement) {
  return guarded([&] {
    required(placement, "The pointer to the placement");
    const ObjectMotion motion = motion_of(*placement);
    arm_of(arm).scene().move(number, placement_of(*placement), motion.velocity_m_per_s, motion.spin_rad_per_s);
  });
}

inkwell_result inkwell_scene_set_material(inkwell_arm* arm, uint32_t number, const inkwell_material* material) {
  return guarded([&] {
    required(material, "The pointer to the material");
    arm_of(arm).scene().set_material(number, material_of(*material));
  });
}

inkwell_result inkwell_scene_remove(inkwell_arm* arm, uint32_t number) {
  return guarded([&] { arm_of(arm).scene().remove(number); });
}

inkwell_result inkwell_scene_clear(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).scene().clear(); });
}

inkwell_result inkwell_scene_get_contacts(inkwell_arm* arm, inkwell_contact* contacts, size_t size, size_t capacity,
                                          size_t* count) {
  return guarded([&] {
    *required(count, "The count") = 0;
    if (capacity > 0) required(contacts, "The list of contacts");
    check_size(size, sizeof(inkwell_contact), "inkwell_contact");
    const feel::ServoView view = arm_of(arm).scene().view();
    *count = view.contact_count;
    for (std::size_t i = 0; i < std::min(capacity, view.contact_count); ++i)
      copy_element(contact_of(view.contacts[i], view.time_s), contacts, i, size);
  });
}

inkwell_result inkwell_scene_read_events(inkwell_arm* arm, inkwell_event* events, size_t size, size_t capacity,
                                         size_t* count, uint64_t* lost) {
  return guarded([&] {
    *required(count, "The count") = 0;
    if (capacity > 0) required(events, "The list of events");
    check_size(size, sizeof(inkwell_event), "inkwell_event");
    std::uint64_t now_lost = 0;
    const auto taken = arm_of(arm).scene().take_events(capacity, now_lost);
    if (lost != nullptr) *lost = now_lost;
    for (const feel::Event& event : taken) {
      const inkwell_event whole{static_cast<inkwell_event_kind>(event.kind), event.button, event.time_s,
                                contact_of(event.contact, event.contact_time_s)};
      copy_element(whole, events, (*count)++, size);
    }
  });
}
