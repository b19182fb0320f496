// What a force law of one's own is made of. docs/force-laws.md is the way to the first one; the paper's box, in
// firmware/force_laws/box.hpp, is the one that an image has unless it is told otherwise.
//
// A law is a struct named like its file, in inkwell::force_laws, with
//
//   Parameters, Signals   structs of floats, whose rows are in `parameter_rows` and `signal_rows`; both may be empty
//   State                 what it remembers from one control period to the next
//   force_N               the function: the force on the hand, 20 000 times a second while the force is on
//
// It is pure: what it knows it is given, so it runs in a test on the PC as it does in the control interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <control/contact.hpp>
#include <control/trigonometry.hpp>
#include <control/vector.hpp>
#include <protocol/reports.hpp>

namespace inkwell::control {

/// What a force law is given in each control period.
struct Probe {
  Vector3 position_m;        ///< workspace axes
  Vector3 velocity_m_per_s;  ///< from the adaptive window
  Triple joint_rad{};
  Triple gimbal_rad{};        ///< yaw, pitch and roll of the stylus; one of them new in each period
  std::uint8_t switches = 0;  ///< bits of protocol::Switch
  Contact contact{};          ///< with the walls of the box, by the parameters of the table
  Wall wall{};                ///< how these walls feel
  std::uint32_t periods = 0;  ///< control periods since the law's force is felt, at which its state was new

  constexpr float time_s() const { return protocol::servo_period_s * static_cast<float>(periods); }
};

/// A row of a law's `parameter_rows`: what moves the slider, and where the law finds its value.
template <class Parameters>
struct ForceParameter {
  float Parameters::*value;
  std::string_view name;  ///< ends in its unit, as rows of the table do
  std::string_view unit;  ///< empty for a pure number
  float minimum;
  float maximum;
  float default_value;
  std::string_view help;
};

/// A row of a law's `signal_rows`: what the scope and recordings take from it.
template <class Signals>
struct ForceSignal {
  float Signals::*value;
  std::string_view name;
  std::string_view unit;
  std::string_view help;
};

/// What the walls of the box give: for a law that keeps them.
inline Vector3 wall_force_N(const Probe& probe) {
  return wall_force_N(probe.contact, probe.velocity_m_per_s, probe.wall);
}

}  // namespace inkwell::control

namespace inkwell::force_laws {
using namespace control;
}
