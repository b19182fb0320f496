#include "host/feel/servo.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <variant>

#include <glm/geometric.hpp>

#include "firmware/control/settings.hpp"
#include "host/client/device/device.hpp"
#include "host/client/kinematics/stylus.hpp"
#include "host/feel/device_model.hpp"

namespace inkwell::feel {
namespace {

using Clock = std::chrono::steady_clock;

std::array<float, 3> array_of(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

glm::dvec3 vector_of(const float (&values)[3]) {
  return {static_cast<double>(values[0]), static_cast<double>(values[1]), static_cast<double>(values[2])};
}

contact::Shape without_owner(const contact::Shape& shape) {
  if (const auto* surface = std::get_if<std::shared_ptr<const geometry::Surface>>(&shape))
    return std::shared_ptr<const geometry::Surface>(std::shared_ptr<void>(), surface->get());
  return shape;
}

}  // namespace

void Servo::follow_publication(double time_s) {
  const contact::Scene* const newest = publication_.latest();
  if (newest == published_) return;
  published_ = newest;
  published_at_s_ = time_s;
  scene_.objects.reserve(contact::objects_max);
  scene_.objects.clear();
  const std::size_t count = std::min(newest->objects.size(), contact::objects_max);
  for (std::size_t index = 0; index < count; ++index) {
    contact::Object object = newest->objects[index];
    object.shape = without_owner(object.shape);
    scene_.objects.push_back(std::move(object));
  }
  scene_.materials = newest->materials;
  materials_are_new_ = true;
  if (grab_.is_holding() && find_object(grab_.object()) == nullptr) grab_.cancel();
}

void Servo::move_objects(double time_s) {
  const double age_s = time_s - published_at_s_;
  for (std::size_t index = 0; index < scene_.objects.size(); ++index) {
    const contact::Object& published = published_->objects[index];
    if (!published.moves() || (grab_.is_holding() && grab_.object() == published.id)) continue;
    contact::Object& moved = scene_.objects[index];
    moved.placement = contact::placement_after(published, age_s);
    if (age_s >= contact::motion_max_s) moved.velocity_m_per_s = moved.spin_rad_per_s = {};
  }
}

contact::Object* Servo::find_object(std::uint32_t id) {
  const auto found = std::ranges::find(scene_.objects, id, &contact::Object::id);
  return found == scene_.objects.end() ? nullptr : &*found;
}

void Servo::follow_parameters(const device::DrivenPose& driven) {
  // Another session counts its revisions from the start.
  if (!driven.is_first && driven.parameters_revision == known_revision_) return;
  known_revision_ = driven.parameters_revision;
  arm_ = control::prepare(driven.parameters).arm;
  // The contact step raises a radius below contact::tip_radius_min_m.
  const auto radius_m = static_cast<double>(driven.parameters[protocol::Parameter::sphere_radius_m]);
  // A larger tip would overlap the touched object.
  if (radius_m != tool_.radius_m) tool_.is_placed = false;
  tool_.radius_m = radius_m;
  force_limit_N_ = static_cast<double>(driven.parameters[protocol::Parameter::force_limit_N]);
}

void Servo::follow_button(const device::Pose& pose, const HandPlacement& hand) {
  const double time_s = device::board_time_s(pose.time_periods);
  const bool is_pressed = is_closed(pose.switches, protocol::Switch::button_1);
  const bool begins = is_pressed && !was_pressed_;
  was_pressed_ = is_pressed;
  if (grab_.is_holding()) {
    contact::Object& object = *find_object(grab_.object());
    if (is_pressed)
      grab_.follow(object, hand, time_s);
    else
      grab_.end(object);
    return;
  }
  if (!begins || newest_step_.contact_count == 0) return;
  const std::uint32_t id = newest_step_.contacts[0].object;
  const contact::Object* const object = find_object(id);
  if (object == nullptr) return;
  grab_.begin(*object, hand, time_s);
  tool_.proxy_m = hand.position_m;
  // The model of the grabbed object expires, so that its force fades. An empty model would end the force at once.
  sent_features_ = false;
  for (std::size_t index = 0; index < tool_.known_count; ++index)
    if (tool_.known[index].id == id) tool_.known[index].is_ignored = true;
}

std::optional<device::LocalModel> Servo::step(const device::DrivenPose& driven) {
  const device::Pose& pose = driven.pose;
  const double time_s = device::board_time_s(pose.time_periods);
  follow_parameters(driven);
  follow_publication(time_s);
  if (published_ == nullptr) return std::nullopt;
  move_objects(time_s);
  const bool is_felt = pose.is_referenced && protocol::force_is_on(pose.state);
  if (!is_felt || driven.is_first) {
    // Without a force the hand may enter an object. The hand feels that object after the tip has left it.
    tool_.is_placed = false;
    sent_features_ = false;
    newest_step_ = {};
    velocity_ = {};
  }
  if (!pose.is_referenced) {
    show(time_s);
    return std::nullopt;
  }
  const glm::dvec3 position_m = vector_of(pose.position_m);
  velocity_.add(time_s, {position_m.x, position_m.y, position_m.z});
  const auto velocity_m_s = velocity_.velocity_m_s();
  if (button_ == ButtonUse::grabs)
    follow_button(pose, {position_m, glm::quat_cast(glm::dmat3(kinematics::stylus_rotation(
                                         array_of(pose.joint_rad), array_of(pose.gimbal_rad), arm_)))});
  const auto begin = Clock::now();
  newest_step_ = contact::step(scene_, tool_,
                               {.position_m = position_m,
                                .velocity_m_per_s = {velocity_m_s[0], velocity_m_s[1], velocity_m_s[2]},
                                .force_N = pose.limits == 0 ? vector_of(pose.force_N) : glm::dvec3{},
                                .force_limit_N = force_limit_N_,
                                .sequence = static_cast<std::uint32_t>(pose.sequence)});
  counters_.longest_step_s =
      std::max(counters_.longest_step_s, std::chrono::duration<double>(Clock::now() - begin).count());
  ++counters_.steps;
  show(time_s);
  const bool has_features = newest_step_.model.count > 0;
  if (!is_felt || !driven.is_newest) return std::nullopt;
  if (!has_features && !sent_features_) return std::nullopt;
  sent_features_ = has_features;
  return device_model(newest_step_.model);
}

void Servo::follow(device::Device& device, const device::DrivenPose& driven) {
  if (driven.is_first) materials_are_new_ = true;
  const auto model = step(driven);
  if (published_ != nullptr && materials_are_new_) {
    device.place_shapes({.materials = device_materials(scene_)});
    materials_are_new_ = false;
  }
  if (!model) return;
  device.send_local_model(
      *model, {.mode = protocol::ForceMode::none, .pose_sequence = static_cast<std::uint32_t>(driven.pose.sequence)});
  ++counters_.models_sent;
}

void Servo::show(double time_s) {
  // A reader that copies the view right now sees the next step.
  const std::unique_lock lock(view_mutex_, std::try_to_lock);
  if (!lock) return;
  view_.object_count = scene_.objects.size();
  for (std::size_t index = 0; index < scene_.objects.size(); ++index)
    view_.objects[index] = {scene_.objects[index].id, scene_.objects[index].placement};
  view_.contacts = newest_step_.contacts;
  view_.contact_count = newest_step_.contact_count;
  view_.held = grab_.is_holding() ? std::optional(grab_.object()) : std::nullopt;
  view_.time_s = time_s;
  view_.counters = counters_;
}

ServoView Servo::view() const {
  const std::lock_guard lock(view_mutex_);
  return view_;
}

}  // namespace inkwell::feel
