// A viscous field. The force is opposite and proportional to the velocity.
//
//   Usage: viscous_field [ADDRESS]     address of the arm for inkwell_open()
#include <cstdio>

#include <inkwell/inkwell.hpp>

constexpr double damping_Ns_per_m = 4;

int main(int argc, char** argv) try {
  inkwell::Arm arm(argc > 1 ? argv[1] : "");
  arm.enable_force();
  arm.start_servo([](const inkwell::Pose& pose) {
    inkwell::Vector force_N;
    for (int i = 0; i < 3; ++i) force_N[i] = -damping_Ns_per_m * pose.velocity_m_s[i];
    return force_N;
  });
  std::puts("Press Enter to end.");
  std::getchar();
  arm.stop_servo();
} catch (const inkwell::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return 1;
}
