// The two kinds of arm that the tests run on, and a repeatable source of random numbers.
#pragma once

#include <cstdint>

#include <control/settings.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::tests {

/// As boards/arms/omni.toml: a parallelogram in the Omni's frame.
inline protocol::ParameterSet omni_parameters() {
  using enum protocol::Parameter;
  protocol::ParameterSet set = protocol::default_parameters();
  set[transmission] = 1.0f;
  set[frame] = 1.0f;
  set[link_2_m] = 0.13335f;
  set[link_3_m] = 0.13335f;
  set[elbow_offset_rad] = -1.5707963f;
  set[origin_x_m] = 0.0f;
  set[origin_y_m] = 0.02335f;
  set[origin_z_m] = -0.16835f;
  set[joint_1_minimum_rad] = -0.98f;
  set[joint_1_maximum_rad] = 0.98f;
  set[joint_2_minimum_rad] = 0.0f;
  set[joint_2_maximum_rad] = 1.75f;
  set[elbow_minimum_rad] = -0.81f;
  set[elbow_maximum_rad] = 1.25f;
  set[inkwell_joint_1_rad] = 0.0f;
  set[inkwell_joint_2_rad] = 0.25f;
  set[inkwell_joint_3_rad] = 0.1f;
  return set;
}

/// As boards/arms/paper.toml: the serial Denavit-Hartenberg arm of the paper's Table 1.
inline protocol::ParameterSet paper_parameters() {
  using enum protocol::Parameter;
  protocol::ParameterSet set = protocol::default_parameters();
  set[transmission] = 0.0f;
  set[frame] = 0.0f;
  set[link_2_m] = 0.14f;
  set[link_3_m] = 0.14f;
  set[elbow_offset_rad] = 0.0f;
  set[origin_x_m] = 0.0f;
  set[origin_y_m] = 0.0f;
  set[origin_z_m] = 0.0f;
  set[joint_1_minimum_rad] = -1.0f;
  set[joint_1_maximum_rad] = 2.2f;
  set[joint_2_minimum_rad] = 0.0f;
  set[joint_2_maximum_rad] = 1.75f;
  set[elbow_minimum_rad] = -2.4f;
  set[elbow_maximum_rad] = -0.3f;
  set[inkwell_joint_1_rad] = 0.0f;
  set[inkwell_joint_2_rad] = 0.9f;
  set[inkwell_joint_3_rad] = -2.0f;
  return set;
}

/// Uniform numbers, the same on every machine (a 32-bit linear congruential generator, upper bits).
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

/// Joint angles anywhere between the stops.
inline control::Triple random_joints(const protocol::ParameterSet& set, Random& random) {
  using enum protocol::Parameter;
  const float joint_1_rad = random.between(set[joint_1_minimum_rad], set[joint_1_maximum_rad]);
  const float joint_2_rad = random.between(set[joint_2_minimum_rad], set[joint_2_maximum_rad]);
  const float elbow_rad = random.between(set[elbow_minimum_rad], set[elbow_maximum_rad]);
  return {joint_1_rad, joint_2_rad, set[transmission] == 0.0f ? elbow_rad : joint_2_rad + elbow_rad};
}

}  // namespace inkwell::tests
