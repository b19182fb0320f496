// The parameters as the control interrupt wants them: every product and reciprocal ready.
#pragma once

#include <cstdint>

#include <control/contact.hpp>
#include <control/current_loop.hpp>
#include <control/encoders.hpp>
#include <control/energy_reserve.hpp>
#include <control/installed_force_law.hpp>
#include <control/kinematics.hpp>
#include <control/motor_heat.hpp>
#include <control/motor_watch.hpp>
#include <control/program_force.hpp>
#include <control/speed_limit.hpp>
#include <control/torque.hpp>
#include <protocol/parameters.hpp>

namespace inkwell::control {

/// Angle = square r^2 + slope r + offset of one gimbal potentiometer.
struct GimbalCurve {
  float square_rad;
  float slope_rad;
  float offset_rad;
};

/// What makes the supervisor switch off.
struct Limits {
  Triple joint_minimum_rad;  ///< third entry: the elbow, relative to link 2 on every arm
  Triple joint_maximum_rad;
  Triple over_current_A;   ///< a measured current beyond it is a fault, once it had time to fall below
  Triple moving_A;         ///< an encoder that stands while its motor's current changes by more is a fault
  Triple brake_A;          ///< that the force limit takes: motors that brake are let go beyond it
  float inkwell_play_rad;  ///< farther from the inkwell its switch is not closed by the stylus
  float speed_limit_squared_m2_per_s2;
  std::uint32_t host_timeout_periods;
};

struct Settings {
  Arm arm;
  EncoderScale encoders;
  std::array<GimbalCurve, 3> gimbal;
  Box box;  ///< already smaller by the sphere's radius
  Wall wall;
  ForceLawValues force_law;
  float force_limit_N;          ///< bound of the magnitude of all that is rendered together
  float recovery_N_per_period;  ///< how fast a force gets over a jump of what it is made of (Transition)
  ProgramForceLimits program_force;
  float ramp_per_period;     ///< rise of the force's gain in one control period
  float landing_per_period;  ///< its fall in an orderly end
  float change_squared_N2;   ///< square of the most by which the force changes in a period, whatever it comes from
  EnergyLimits energy;
  SpeedLimit speed;
  Motors motors;
  HeatScale heat;
  MotorModel motor_model;
  CurrentLoopGains current_loop;
  Limits limits;
};

/// Turns a checked set of parameters into settings. Divides and is not short: for the main loop only.
Settings prepare(const protocol::ParameterSet& parameters);

}  // namespace inkwell::control
