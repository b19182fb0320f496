// Objects of a program that the hand can feel. The contact servo of host/feel runs in the thread that reads the poses.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "host/client/device/session.hpp"
#include "host/contact/publication.hpp"
#include "host/contact/scene.hpp"
#include "host/feel/events.hpp"
#include "host/feel/servo.hpp"

namespace inkwell::library {

class Scene {
 public:
  /// Sends the materials to the device if this program drives the arm. Otherwise returns false.
  using PlaceMaterials = std::function<bool(const contact::Scene&)>;

  explicit Scene(PlaceMaterials place_materials);

  // ---- threads of the program. These functions throw BadArgument, NotNow or an error of the device, and then change
  // nothing.

  /// Adds the object and returns its number, which counts from 1. Ignores Object::id and Object::material.
  std::uint32_t add(contact::Object object, const contact::Material& material);
  void move(std::uint32_t number, const contact::Placement& placement, const glm::dvec3& velocity_m_per_s,
            const glm::dvec3& spin_rad_per_s);
  void set_material(std::uint32_t number, const contact::Material& material);
  void remove(std::uint32_t number);
  void clear();

  /// Contacts of the newest step; none while the scene is not felt.
  feel::ServoView view() const;
  /// The oldest events, at most `capacity`. Writes the number of lost events since the last call to `lost`.
  std::vector<feel::Event> take_events(std::size_t capacity, std::uint64_t& lost);

  /// True from the first object on.
  bool is_used() const { return is_used_; }
  /// True if the scene has objects and the device does not know their materials.
  bool lacks_materials() const { return is_used_ && !has_placed_materials_; }
  /// The device may have other materials, because this program does not drive the arm.
  void forget_materials() { has_placed_materials_ = false; }
  void send_materials();

  void set_parameters(const protocol::ParameterSet& parameters);
  /// No step runs after this function returns.
  void stop();

  // ---- thread that reads the poses. The functions allocate memory only at the first scene.

  /// Local model for the device.
  struct Model {
    device::LocalModel model;
    double force_life_s;  ///< parameter program_force_expiry_s
  };
  /// Runs a contact step and passes the local model for the device to `send`. `drives`: this program drives the arm.
  template <class Send>
  void follow(const device::Pose& pose, bool drives, Send send) {
    const std::lock_guard lock(servo_mutex_);
    if (const auto model = step(pose, drives)) send(*model);
  }

 private:
  void publish(contact::Scene next);
  std::optional<Model> step(const device::Pose& pose, bool drives);

  const PlaceMaterials place_materials_;

  std::mutex edit_mutex_;  ///< guards the next members
  contact::Publication publication_;
  contact::Scene scene_;
  std::uint32_t newest_number_ = 0;

  std::mutex events_mutex_;  ///< one thread reads the events at a time
  std::uint64_t known_lost_ = 0;
  feel::EventQueue events_;

  std::atomic<bool> is_used_ = false, has_placed_materials_ = false, is_followed_ = false;

  std::mutex servo_mutex_;  ///< guards the next members; the pose thread waits only while they are assigned
  protocol::ParameterSet parameters_{};
  std::uint64_t parameters_revision_ = 0;
  bool is_stopped_ = false;
  feel::Servo servo_;
  feel::EventWatch watch_;
};

}  // namespace inkwell::library
