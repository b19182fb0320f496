// A sphere in the middle of the box. The board renders the sphere at the full servo rate. This program renews the
// sphere regularly. When the program exits, the sphere expires.
//
//   Usage: sphere [ADDRESS]     address of the arm for inkwell_open()
#include <chrono>
#include <cstdio>
#include <future>

#include <inkwell/inkwell.hpp>

int main(int argc, char** argv) try {
  const inkwell::Sphere sphere{.centre_m = {0, 0, -0.03},
                               .radius_m = 0.02,
                               .surface = {.stiffness_N_per_m = 800,
                                           .damping_Ns_per_m = 2,
                                           .static_friction = 0.2,
                                           .dynamic_friction = 0.15,
                                           .life_s = 5}};
  inkwell::Arm arm(argc > 1 ? argv[1] : "");
  arm.enable_force();
  std::puts("Press Enter to end.");
  const auto enter = std::async(std::launch::async, [] { return std::getchar(); });
  do arm.place_shapes({}, &sphere);
  while (enter.wait_for(std::chrono::seconds(1)) == std::future_status::timeout);
} catch (const inkwell::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return 1;
}
