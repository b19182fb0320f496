// The C++ wrapper requires only C++14, without warnings.
#include <inkwell/inkwell.hpp>

static_assert(__cplusplus == 201402L, "this file must be compiled as C++14");

void use_each_kind_of_call(inkwell::Arm& arm);
void use_each_kind_of_call(inkwell::Arm& arm) {
  arm.start_servo([](const inkwell::Pose&) { return inkwell::Vector{}; });
  arm.set_parameters({{"force_limit_N", 1.0}});
  arm.set_joint_torques({0.0, 0.0, arm.state().joint_torque_Nm[2]});
}
