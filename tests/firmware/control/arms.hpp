// The arms of the tests, and a reproducible random number generator.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <arm_files.hpp>
#include "firmware/control/settings.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::tests {

struct Arm {
  std::string_view name;
  protocol::ParameterSet parameters;
};

/// Returns all arms of boards/arms/ with the parameters of their descriptions.
inline std::vector<Arm> all_arms() {
  std::vector<Arm> arms;
  for (const ArmFile& file : arm_files) {
    Arm arm{file.name, protocol::default_parameters()};
    for (const ArmRow& row : file.rows) arm.parameters[row.parameter] = row.value;
    arms.push_back(arm);
  }
  return arms;
}

inline protocol::ParameterSet parameters_of(std::string_view name) {
  for (const Arm& arm : all_arms())
    if (arm.name == name) return arm.parameters;
  return {};
}

/// A parallelogram arm in the Omni's frame.
inline protocol::ParameterSet omni_parameters() { return parameters_of("omni"); }
/// The same arm with motors that the user has confirmed.
inline protocol::ParameterSet confirmed_omni_parameters() {
  protocol::ParameterSet set = omni_parameters();
  set[protocol::Parameter::motors_confirmed] = 1.0f;
  return set;
}
/// The serial Denavit-Hartenberg arm of the paper's Table 1.
inline protocol::ParameterSet paper_parameters() { return parameters_of("paper"); }

/// Uniform random numbers, equal on all machines (upper bits of a 32-bit linear congruential generator).
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  float between(float low, float high) {
    state_ = state_ * 1664525u + 1013904223u;
    return low + (high - low) * static_cast<float>(state_ >> 8) * 0x1p-24f;
  }

 private:
  std::uint32_t state_;
};

/// Returns random joint angles between the stops.
inline control::Triple random_joints(const protocol::ParameterSet& set, Random& random) {
  using enum protocol::Parameter;
  const float joint_1_rad = random.between(set[joint_1_minimum_rad], set[joint_1_maximum_rad]);
  const float joint_2_rad = random.between(set[joint_2_minimum_rad], set[joint_2_maximum_rad]);
  const float elbow_rad = random.between(set[elbow_minimum_rad], set[elbow_maximum_rad]);
  return {joint_1_rad, joint_2_rad, set[transmission] == 0.0f ? elbow_rad : joint_2_rad + elbow_rad};
}

}  // namespace inkwell::tests
