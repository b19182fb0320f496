// HDAPI force limits: maximum force, rate of change, speed limit, and ramp after an interruption.
#pragma once

#include <array>

#include "host/bindings/dropins/constants.hpp"

namespace inkwell::dropins {

using Vector = std::array<double, 3>;

double length(const Vector& vector);

struct ForceLimits {
  double maximum_N;
  double speed_m_per_s;
  double change_N_per_ms;
  double ramp_N_per_s;
  bool clamps, ramps, limits_force, limits_speed, limits_change;
};

struct ForceDemand {
  Vector force_N;
  double speed_m_per_s;
  double time_s;  ///< board time
  bool is_on;     ///< the arm's force is on, and the stylus is out of the inkwell
};

class ForceGuard {
 public:
  struct Answer {
    Vector force_N;
    ErrorCode error;  ///< `success`, or the reason why there is no force
  };
  Answer step(const ForceDemand& demand, const ForceLimits& limits);

 private:
  Answer drop(ErrorCode why);

  double ramp_N_ = 0.0;  ///< current upper limit of the force
  double time_s_ = 0.0;
  Vector before_N_{};
  Vector earlier_N_{};  ///< the last force at the previous pose
  double since_earlier_s_ = 0.0;
};

}  // namespace inkwell::dropins
