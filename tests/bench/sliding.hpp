// A hand that slides over a ball of 327,680 triangles, for comparing the speed of contact engines.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "host/geometry/examples.hpp"

namespace inkwell::sliding {

inline constexpr double radius_m = 0.05;
inline constexpr double tip_radius_m = 0.001;
inline constexpr double speed_m_per_s = 0.1;
inline constexpr int approach_steps = 200;
inline constexpr int steps = 20000;

inline geometry::Mesh ball() { return geometry::make_ball(radius_m, 0.0005, 7); }

/// Approaches the ball and then moves along it, 1 mm below the surface of a ball without waves. `free`: 20 mm above it.
inline glm::dvec3 hand_m(int step, bool free) {
  const double angle_rad = step * speed_m_per_s * 0.001 / radius_m;
  const double fraction = std::clamp(1.0 + static_cast<double>(step) / approach_steps, 0.0, 1.0);
  const double distance_m = free ? 0.07 : 0.06 + (radius_m + tip_radius_m - 0.001 - 0.06) * fraction;
  return glm::normalize(glm::dvec3{std::cos(angle_rad), std::sin(angle_rad) * std::cos(0.3 * angle_rad),
                                   std::sin(0.3 * angle_rad)}) *
         distance_m;
}

/// Calls `step(hand_m)` for each millisecond and prints the durations of the steps after the approach. `step` returns
/// true in contact.
template <class Step>
void measure(const char* name, bool free, const Step& step) {
  std::vector<double> durations_us;
  int contacts = 0;
  for (int number = -approach_steps; number < steps; ++number) {
    const glm::dvec3 position_m = hand_m(number, free);
    const auto start = std::chrono::steady_clock::now();
    const bool touches = step(position_m);
    const std::chrono::duration<double, std::micro> duration_us = std::chrono::steady_clock::now() - start;
    if (number < 0) continue;
    durations_us.push_back(duration_us.count());
    contacts += touches ? 1 : 0;
  }
  std::ranges::sort(durations_us);
  std::printf("%-36s median %7.2f us, 99 %% %8.2f us, in contact %3.0f %%\n", name,
              durations_us[durations_us.size() / 2], durations_us[durations_us.size() * 99 / 100],
              100.0 * contacts / steps);
}

}  // namespace inkwell::sliding
