// Interface of custom force laws. The page docs/force-laws.md describes how to write a law. The default law of an image
// is the paper's box in firmware/force_laws/box.hpp.
//
// A law is a struct in inkwell::force_laws. The struct has the name of its file and the following members.
//
//   `Parameters`   contains floats with rows in `parameter_rows`, and may be empty.
//   `Signals`      contains floats with rows in `signal_rows`, and may be empty.
//   `State`        contains the state between control periods.
//   `force_N`      returns the force on the hand, 20 000 times per second while the force is on.
//
// A law uses only its arguments, so a test on the PC can run the same code as the control interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware/control/signal_path/contact.hpp"
#include "firmware/control/signal_path/trigonometry.hpp"
#include "firmware/control/signal_path/vector.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// Input of a force law in each control period.
struct Probe {
  Vector3 position_m;        ///< workspace axes
  Vector3 velocity_m_per_s;  ///< estimated with the adaptive window
  Triple joint_rad{};
  Triple gimbal_rad{};        ///< yaw, pitch and roll of the stylus; one angle is updated per period
  std::uint8_t switches = 0;  ///< bits of protocol::Switch
  Contact contact{};          ///< contact with the box walls defined by the parameters
  Wall wall{};                ///< stiffness and damping of these walls
  std::uint32_t periods = 0;  ///< control periods since the law became active with a new state

  constexpr float time_s() const { return protocol::servo_period_s * static_cast<float>(periods); }
};

/// Row of a law's `parameter_rows`: one parameter and the struct member for its value.
template <class Parameters>
struct ForceParameter {
  float Parameters::*value;
  std::string_view name;  ///< ends with its unit, as in the parameter table
  std::string_view unit;  ///< empty for a pure number
  float minimum;
  float maximum;
  float default_value;
  std::string_view help;
};

/// Row of a law's `signal_rows`: one signal for the scope and for recordings.
template <class Signals>
struct ForceSignal {
  float Signals::*value;
  std::string_view name;
  std::string_view unit;
  std::string_view help;
};

/// Force of the box walls, for laws that include these walls.
inline Vector3 wall_force_N(const Probe& probe) {
  return wall_force_N(probe.contact, probe.velocity_m_per_s, probe.wall);
}

}  // namespace inkwell::control

namespace inkwell::force_laws {
using namespace control;
}
