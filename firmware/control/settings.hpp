// Settings of the control interrupt, computed from the parameters.
#pragma once

#include <cstdint>

#include "firmware/control/signal_path/contact.hpp"
#include "firmware/control/signal_path/current_loop.hpp"
#include "firmware/control/signal_path/encoders.hpp"
#include "firmware/control/signal_path/energy_reserve.hpp"
#include "firmware/control/signal_path/installed_force_law.hpp"
#include "firmware/control/signal_path/kinematics.hpp"
#include "firmware/control/signal_path/program_force.hpp"
#include "firmware/control/signal_path/speed_limit.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "firmware/control/signal_path/torque.hpp"
#include "firmware/control/supervision/motor_check.hpp"
#include "firmware/control/supervision/motor_heat.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::control {

/// Gimbal angle = square r^2 + slope r + offset for the potentiometer reading r.
struct GimbalCurve {
  float square_rad;
  float slope_rad;
  float offset_rad;
};

/// Bounds of the supervisor's fault checks.
struct Limits {
  Triple joint_minimum_rad;  ///< third entry: elbow angle relative to link 2, on every arm
  Triple joint_maximum_rad;
  Triple over_current_A;   ///< bound of a measured current, after the time in which the current falls
  Triple moving_A;         ///< current change that turns a joint; if the encoder does not change, it is stuck
  Triple brake_A;          ///< current at the force limit; braking motors are released above this current
  float inkwell_play_rad;  ///< joint angle from the inkwell, beyond which the stylus cannot close the inkwell switch
  float speed_limit_squared_m2_per_s2;
  std::uint32_t host_timeout_periods;
};

struct Settings {
  Arm arm;
  EncoderScale encoders;
  std::array<GimbalCurve, 3> gimbal;
  Box box;  ///< already reduced by the sphere radius
  Surface wall;
  ForceLawValues force_law;
  float force_limit_N;          ///< bound of the magnitude of the total force
  ForceLimit contact_limit;     ///< the same bound for touched objects
  float recovery_N_per_period;  ///< recovery rate after a jump of a force component (Transition)
  ProgramForceLimits program_force;
  float ramp_per_period;     ///< rise of the force gain per control period
  float landing_per_period;  ///< fall of the force gain per control period in a regular stop
  float change_squared_N2;   ///< square of the largest force change per period
  EnergyLimits energy;
  SpeedLimit speed;
  Motors motors;
  HeatScale heat;
  MotorModel motor_model;
  CurrentLoopGains current_loop;
  Limits limits;
};

/// Converts a validated set of parameters to settings. Only the main loop calls this function, because its divisions
/// are slow.
Settings prepare(const protocol::ParameterSet& parameters);

}  // namespace inkwell::control
