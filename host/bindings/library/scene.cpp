#include "host/bindings/library/scene.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "host/feel/device_model.hpp"

#include "host/bindings/library/errors.hpp"
#include "host/bindings/library/priority.hpp"

namespace inkwell::library {
namespace {

contact::Object& object_of(contact::Scene& scene, std::uint32_t number) {
  const auto found = std::ranges::find(scene.objects, number, &contact::Object::id);
  if (found == scene.objects.end())
    throw BadArgument(fmt::format("The scene does not contain object {}. Give the number of an added object.", number));
  return *found;
}

void require_valid(const contact::Material& material) {
  contact::Scene scene;
  scene.materials.fill(material);
  try {
    device::shapes_report({.materials = feel::device_materials(scene)});
  } catch (const device::Error& error) {
    throw BadArgument(error.what());
  }
}

/// Index of the material in the scene. A material without objects is replaced.
std::uint8_t add_material(contact::Scene& scene, const contact::Material& material) {
  const auto& all = scene.materials;
  const auto is_used = [&](std::size_t index) {
    return std::ranges::any_of(scene.objects, [&](const auto& object) { return object.material == index; });
  };
  std::size_t index = static_cast<std::size_t>(std::ranges::find(all, material) - all.begin());
  if (index == all.size())
    for (index = 0; index < all.size() && is_used(index);) ++index;
  if (index == all.size())
    throw NotNow(fmt::format("The scene has {} different materials already. Use one of them, or remove objects.",
                             contact::materials_max));
  scene.materials[index] = material;
  return static_cast<std::uint8_t>(index);
}

}  // namespace

Scene::Scene(PlaceMaterials place_materials)
    : place_materials_(std::move(place_materials)), servo_(publication_, feel::ButtonUse::none) {
  inherit_priority(servo_mutex_);
}

// ---- threads of the program ---------------------------------------------------------------------------------

std::uint32_t Scene::add(contact::Object object, const contact::Material& material) {
  require_valid(material);
  const std::lock_guard lock(edit_mutex_);
  if (scene_.objects.size() == contact::objects_max)
    throw NotNow(fmt::format("The scene has {} objects already. Remove an object first.", contact::objects_max));
  contact::Scene next = scene_;
  object.material = add_material(next, material);
  object.id = newest_number_ + 1;
  next.objects.push_back(std::move(object));
  publish(std::move(next));
  return ++newest_number_;
}

void Scene::move(std::uint32_t number, const contact::Placement& placement, const glm::dvec3& velocity_m_per_s,
                 const glm::dvec3& spin_rad_per_s) {
  const std::lock_guard lock(edit_mutex_);
  contact::Scene next = scene_;
  contact::Object& object = object_of(next, number);
  object.placement = placement;
  object.velocity_m_per_s = velocity_m_per_s;
  object.spin_rad_per_s = spin_rad_per_s;
  publish(std::move(next));
}

void Scene::set_material(std::uint32_t number, const contact::Material& material) {
  require_valid(material);
  const std::lock_guard lock(edit_mutex_);
  contact::Scene next = scene_;
  contact::Object& object = object_of(next, number);
  object.material = contact::materials_max;  // the previous material may be replaced
  object.material = add_material(next, material);
  publish(std::move(next));
}

void Scene::remove(std::uint32_t number) {
  const std::lock_guard lock(edit_mutex_);
  contact::Scene next = scene_;
  object_of(next, number);
  std::erase_if(next.objects, [&](const contact::Object& object) { return object.id == number; });
  publish(std::move(next));
}

void Scene::clear() {
  const std::lock_guard lock(edit_mutex_);
  if (!scene_.objects.empty()) publish({.objects = {}, .materials = scene_.materials});
}

void Scene::publish(contact::Scene next) {
  if (!has_placed_materials_ || next.materials != scene_.materials) has_placed_materials_ = place_materials_(next);
  scene_ = std::move(next);
  publication_.publish(std::make_shared<const contact::Scene>(scene_));
  is_used_ = true;
}

void Scene::send_materials() {
  const std::lock_guard lock(edit_mutex_);
  has_placed_materials_ = place_materials_(scene_);
}

feel::ServoView Scene::view() const {
  feel::ServoView view = servo_.view();
  if (!is_followed_) view.contact_count = 0;
  return view;
}

std::vector<feel::Event> Scene::take_events(std::size_t capacity, std::uint64_t& lost) {
  const std::lock_guard lock(events_mutex_);
  std::vector<feel::Event> events;
  while (events.size() < capacity) {
    const auto event = events_.take();
    if (!event) break;
    events.push_back(*event);
  }
  const std::uint64_t now_lost = events_.lost();
  lost = now_lost - std::exchange(known_lost_, now_lost);
  return events;
}

void Scene::set_parameters(const protocol::ParameterSet& parameters) {
  const std::lock_guard lock(servo_mutex_);
  parameters_ = parameters;
  ++parameters_revision_;
}

void Scene::stop() {
  const std::lock_guard lock(servo_mutex_);
  is_stopped_ = true;
}

// ---- thread that reads the poses ----------------------------------------------------------------------------

std::optional<Scene::Model> Scene::step(const device::Pose& pose, bool drives) {
  if (is_stopped_) return std::nullopt;
  const double time_s = device::board_time_s(pose.time_periods);
  const bool is_followed = drives && is_used_ && has_placed_materials_;
  const bool is_first = !is_followed_.exchange(is_followed);
  if (!is_followed) {
    watch_.end_touches(time_s, events_);
    return std::nullopt;
  }
  const auto model = servo_.step({pose, parameters_, parameters_revision_, is_first, true});
  watch_.follow(servo_.newest_step(), pose.switches, time_s, events_);
  if (!model) return std::nullopt;
  return Model{*model, static_cast<double>(parameters_[protocol::Parameter::program_force_expiry_s])};
}

}  // namespace inkwell::library
