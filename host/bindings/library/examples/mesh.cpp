// A ball of triangles in the middle of the box.
//
//   Usage: mesh [ADDRESS]     address of the arm for inkwell_open()
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <inkwell/inkwell.hpp>

int main(int argc, char** argv) try {
  constexpr double radius_m = 0.02, pi = 3.14159265358979;
  constexpr std::uint32_t around = 48, rings = 24;
  std::vector<std::array<double, 3>> vertices_m;
  for (std::uint32_t ring = 1; ring < rings; ++ring)
    for (std::uint32_t step = 0; step < around; ++step) {
      const double height_rad = pi * ring / rings, turn_rad = 2 * pi * step / around;
      vertices_m.push_back({radius_m * std::sin(height_rad) * std::cos(turn_rad),
                            radius_m * std::sin(height_rad) * std::sin(turn_rad), radius_m * std::cos(height_rad)});
    }
  vertices_m.push_back({0, 0, radius_m});
  vertices_m.push_back({0, 0, -radius_m});
  constexpr std::uint32_t top = around * (rings - 1), bottom = top + 1, last_ring = around * (rings - 2);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t step = 0; step < around; ++step) {
    const std::uint32_t next = (step + 1) % around;
    triangles.push_back({top, step, next});
    for (std::uint32_t upper = 0; upper < last_ring; upper += around) {
      triangles.push_back({upper + step, upper + around + step, upper + around + next});
      triangles.push_back({upper + step, upper + around + next, upper + next});
    }
    triangles.push_back({bottom, last_ring + next, last_ring + step});
  }

  inkwell::Arm arm(argc > 1 ? argv[1] : "");
  inkwell::Object ball = inkwell::make_mesh(vertices_m, triangles);
  ball.placement.position_m[2] = -0.03;
  ball.material = inkwell::find_material("wood");
  arm.scene_add(ball);
  arm.enable_force();
  std::puts("Press Enter to end.");
  std::getchar();
  for (const inkwell::Event& event : arm.scene_read_events())
    if (event.kind == INKWELL_TOUCHED)
      std::printf("%.3f s: touched triangle %u\n", event.time_s, event.contact.triangle);
} catch (const inkwell::Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return 1;
}
