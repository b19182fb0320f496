// Box of six walls with spring and damper (sections 3.2 and 3.3 of the paper). The box is the default force law.
#pragma once

#include <control/force_law.hpp>

namespace inkwell::force_laws {

struct box {
  static constexpr std::string_view help = "The walls of the box, and nothing else.";

  // The parameter table of every image contains the box parameters.
  struct Parameters {};
  struct Signals {};
  struct State {};

  static Vector3 force_N(const Probe& probe, const Parameters&, State&, Signals&) { return wall_force_N(probe); }
};

}  // namespace inkwell::force_laws
