// An object that follows the hand while the stylus button is pressed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "host/contact/scene.hpp"

namespace inkwell::feel {

struct HandPlacement {
  glm::dvec3 position_m{};
  glm::dquat rotation{1, 0, 0, 0};  ///< of the stylus in the workspace
};

/// Holds one object at the stylus. No call allocates memory.
class Grab {
 public:
  /// The object keeps its placement relative to the stylus.
  void begin(const contact::Object& object, const HandPlacement& hand, double time_s);
  /// Moves the object with the hand. Velocity and spin are averages over at most span_s.
  void follow(contact::Object& object, const HandPlacement& hand, double time_s);
  /// The object remains where the hand released it.
  void end(contact::Object& object);
  /// Forgets the object, for example after it was removed from the scene.
  void cancel() { is_holding_ = false; }

  bool is_holding() const { return is_holding_; }
  /// Object::id. Only valid while is_holding().
  std::uint32_t object() const { return object_; }

  static constexpr double span_s = 0.008;

 private:
  struct Sample {
    double time_s = 0;
    contact::Placement placement{};
  };
  void add(const Sample& sample);

  bool is_holding_ = false;
  std::uint32_t object_ = 0;
  contact::Placement in_hand_;  ///< in the axes of the stylus
  std::array<Sample, 16> samples_{};
  std::size_t count_ = 0;  ///< the newest sample is the last
};

}  // namespace inkwell::feel
