// The paper's box: six walls with a spring and a damper (sections 3.2 and 3.3). The box is the default force law.
#pragma once

#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct box {
  static constexpr std::string_view help = "The walls of the box, and nothing else.";

  // The box parameters (bounds, sphere, stiffness, damping) belong to the arm and are in the parameter table of every
  // image.
  struct Parameters {};
  struct Signals {};
  struct State {};

  static Vector3 force_N(const Probe& probe, const Parameters&, State&, Signals&) { return wall_force_N(probe); }
};

}  // namespace inkwell::force_laws
