// Near the speed limit, the force component along the motion is reduced. The force can brake the arm. Only a hand can
// therefore cause the fault over_speed.
#pragma once

namespace inkwell::control {

struct SpeedLimit {
  float from_squared_m2_per_s2;  ///< square of the speed above which the force is reduced
  float per_squared_m2_per_s2;  ///< 1 / (squared speed at which the driving component is zero - from_squared_m2_per_s2)
};

inline bool is_near(float speed_squared_m2_per_s2, const SpeedLimit& limit) {
  return speed_squared_m2_per_s2 > limit.from_squared_m2_per_s2;
}

/// Returns the fraction (0..1) by which the force component along the motion is reduced.
inline float driving_reduction(float speed_squared_m2_per_s2, const SpeedLimit& limit) {
  const float part = (speed_squared_m2_per_s2 - limit.from_squared_m2_per_s2) * limit.per_squared_m2_per_s2;
  if (!(part > 0.0f)) return 0.0f;
  return part < 1.0f ? part : 1.0f;
}

}  // namespace inkwell::control
