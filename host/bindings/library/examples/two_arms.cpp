// A spring between two arms. Each hand feels the motion of the other hand.
//
//   Usage: inkwell run --arms left,right two_arms     arms with these names; with --virtual, two simulated arms
//          two_arms ADDRESS ADDRESS                   addresses of the arms for inkwell_open()
#include <cstdio>

#include <inkwell/inkwell.hpp>

constexpr double stiffness_N_per_m = 150;

inkwell::Vector pull_N(const inkwell::Pose& from, const inkwell::Pose& to) {
  inkwell::Vector force_N;
  for (int i = 0; i < 3; ++i) force_N[i] = stiffness_N_per_m * (to.position_m[i] - from.position_m[i]);
  return force_N;
}

int main(int argc, char** argv) try {
  if (argc != 1 && argc != 3) {
    std::fputs("Give the addresses of two arms, such as their serial numbers.\n", stderr);
    return 2;
  }
  inkwell::Arm right(argc == 3 ? argv[2] : "right"), left(argc == 3 ? argv[1] : "left");
  left.enable_force();
  right.enable_force();
  left.start_servo([&](const inkwell::Pose& here) {
    const inkwell::Pose there = right.pose();
    right.set_force(pull_N(there, here));
    return pull_N(here, there);
  });
  std::puts("Press Enter to end.");
  std::getchar();
  left.stop_servo();
} catch (const inkwell::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return 1;
}
