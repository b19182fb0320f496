#include <cstdio>

#include <control/trigonometry.hpp>
#include <protocol/parameters.hpp>

int main() {
  const auto found = inkwell::protocol::find_parameter("sphere_radius_m");
  std::printf("%.3f\n", static_cast<double>(inkwell::control::sine_cosine(found ? 0.5f : 0.0f).sine));
}
