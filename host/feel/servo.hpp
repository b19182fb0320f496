// Turns poses into local models of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

#include "firmware/control/signal_path/kinematics.hpp"
#include "host/client/device/session.hpp"
#include "host/client/kinematics/velocity.hpp"
#include "host/contact/publication.hpp"
#include "host/contact/scene.hpp"
#include "host/contact/step.hpp"
#include "host/feel/grab.hpp"

namespace inkwell::feel {

struct ServoCounters {
  std::uint64_t steps = 0;
  std::uint64_t models_sent = 0;
  double longest_step_s = 0;  ///< processor and waiting time of one contact step
};

/// State of the servo after a step.
struct ServoView {
  struct PlacedObject {
    std::uint32_t id = 0;
    contact::Placement placement;
  };
  std::array<PlacedObject, contact::objects_max> objects{};
  std::size_t object_count = 0;
  std::array<contact::Contact, contact::features_max> contacts{};
  std::size_t contact_count = 0;
  std::optional<std::uint32_t> held;  ///< Object::id of the grabbed object
  double time_s = 0;                  ///< board time of the pose
  ServoCounters counters;
};

/// Effect of button 1 of the stylus.
enum class ButtonUse : std::uint8_t {
  /// Grabs the touched object. The hand does not feel a grabbed object, because the object has no weight. After its
  /// release, the object is felt again when the tip has left it.
  grabs,
  none,
};

/// An object with a velocity moves from its published placement on, for at most contact::motion_max_s of board time.
class Servo {
 public:
  /// The publication must outlive the servo.
  explicit Servo(contact::Publication& publication, ButtonUse button = ButtonUse::grabs)
      : publication_(publication), button_(button) {}

  /// Runs a contact step and sends the local model. For Session::on_pose(). Waits for the device only when the
  /// materials are new, and allocates memory only then. Throws device::Error if the device refuses the materials.
  void follow(device::Device& device, const device::DrivenPose& driven);

  /// Runs a contact step. Returns the model for the device, or nullopt if no model must be sent. No memory is allocated
  /// except at the first scene.
  std::optional<device::LocalModel> step(const device::DrivenPose& driven);

  /// Result of the newest step, for the thread that calls step().
  const contact::Step& newest_step() const { return newest_step_; }

  /// The newest state. Any thread may call this function.
  ServoView view() const;

 private:
  void follow_publication(double time_s);
  void move_objects(double time_s);
  void follow_parameters(const device::DrivenPose& driven);
  void follow_button(const device::Pose& pose, const HandPlacement& hand);
  contact::Object* find_object(std::uint32_t id);
  void show(double time_s);

  contact::Publication& publication_;
  const ButtonUse button_;
  const contact::Scene* published_ = nullptr;
  double published_at_s_ = 0;  ///< board time of the first step with the published scene
  /// Copy of the published scene with the moved objects. Its pointers to surfaces own nothing, so that this thread
  /// never frees a mesh. The published scene owns the surfaces.
  contact::Scene scene_;
  bool materials_are_new_ = false;
  contact::Tool tool_;
  double force_limit_N_ = 0;
  contact::Step newest_step_;
  kinematics::VelocityFit velocity_;
  control::Arm arm_{};
  std::uint64_t known_revision_ = 0;
  Grab grab_;
  bool was_pressed_ = true;  ///< a button that is pressed at the start does not grab
  bool sent_features_ = false;
  ServoCounters counters_;

  mutable std::mutex view_mutex_;
  ServoView view_;
};

}  // namespace inkwell::feel
