// Interface of custom force laws. The page docs/force-laws.md describes how to write a law. The default law of an image
// is the paper's box in firmware/force_laws/box.hpp.
//
// A law is a struct in inkwell::force_laws. The struct has the name of its file and the following members.
//
//   `Parameters`   has one float for each row of `parameter_rows`.
//   `Signals`      has one float for each row of `signal_rows`.
//   `State`        contains the state between control periods.
//   `force_N`      returns the force on the hand, at 20 kHz while the force is on.
//
// A law uses only its arguments, so tests on the PC can run it.
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
  Vector3 walls_N;            ///< force of these walls
  std::uint32_t periods = 0;  ///< control periods since the law became active with a new state

  constexpr float time_s() const { return protocol::servo_period_s * static_cast<float>(periods); }
};

/// Row of `parameter_rows`: a parameter and its struct member.
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

/// Row of `signal_rows`: a signal and its struct member.
template <class Signals>
struct ForceSignal {
  float Signals::*value;
  std::string_view name;
  std::string_view unit;
  std::string_view help;
};

/// Returns the force of the box walls.
inline const Vector3& wall_force_N(const Probe& probe) { return probe.walls_N; }

}  // namespace inkwell::control

namespace inkwell::force_laws {
using namespace control;
}
