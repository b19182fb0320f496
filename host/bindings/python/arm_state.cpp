// Calls for states, abilities, joint torques, claims and real time.
#include "host/bindings/python/arm.hpp"

namespace inkwell::python {

inkwell_arm_state Arm::state() {
  const Use arm(*this);
  inkwell_arm_state state;
  call([&] { return inkwell_get_state(arm, &state, sizeof state); });
  return state;
}

inkwell_abilities Arm::abilities() {
  const Use arm(*this);
  inkwell_abilities abilities;
  call([&] { return inkwell_get_abilities(arm, &abilities, sizeof abilities); });
  return abilities;
}

std::pair<Vector, std::array<double, 9>> Arm::forward_kinematics(const Vector& joint_rad) {
  const Use arm(*this);
  std::pair<Vector, std::array<double, 9>> result;
  call([&] { return inkwell_forward_kinematics(arm, joint_rad.data(), result.first.data(), result.second.data()); });
  return result;
}

Vector Arm::force_of_torques(const Vector& joint_rad, const Vector& torque_Nm) {
  const Use arm(*this);
  Vector force_N{};
  call([&] { return inkwell_force_of_torques(arm, joint_rad.data(), torque_Nm.data(), force_N.data()); });
  return force_N;
}

void Arm::set_joint_torques(const Vector& torque_Nm) {
  const Use arm(*this);
  call([&] { return inkwell_set_joint_torques(arm, torque_Nm.data()); });
}

void Arm::claim() {
  const Use arm(*this);
  call([&] { return inkwell_claim(arm); });
}

void Arm::release() {
  const Use arm(*this);
  call([&] { return inkwell_release(arm); });
}

void Arm::set_thread_priority(int priority) {
  const Use arm(*this);
  call([&] { return inkwell_set_thread_priority(arm, priority); });
}

}  // namespace inkwell::python
