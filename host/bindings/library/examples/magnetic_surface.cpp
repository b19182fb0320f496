// A plane at x = 0 that attracts the stylus within 10 mm. A stronger pull releases the stylus.
//
//   Usage: magnetic_surface [ADDRESS]     address of the arm for inkwell_open()
#include <cmath>
#include <cstdio>

#include <inkwell/inkwell.hpp>

constexpr double stiffness_N_per_m = 200, reach_m = 0.010;

/// The force increases linearly up to half of `reach_m`, and then decreases linearly to zero.
double attraction_N(double distance_m) {
  return stiffness_N_per_m * std::fmax(0.0, std::fmin(distance_m, reach_m - distance_m));
}

int main(int argc, char** argv) try {
  inkwell::Arm arm(argc > 1 ? argv[1] : "");
  arm.enable_force();
  arm.start_servo([](const inkwell::Pose& pose) {
    const double x_m = pose.position_m[0];
    return inkwell::Vector{-std::copysign(attraction_N(std::fabs(x_m)), x_m), 0.0, 0.0};
  });
  std::puts("Press Enter to end.");
  std::getchar();
  arm.stop_servo();
} catch (const inkwell::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return 1;
}
