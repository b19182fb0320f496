// What gives way when the probe is nearly as fast as it may be: the force still brakes and holds, but drives no more.
// So neither a program nor a wall throws the arm into the fault over_speed; a hand may.
#pragma once

namespace inkwell::control {

struct SpeedLimit {
  float from_squared_m2_per_s2;  ///< square of the speed from which on the force gives way
  float per_squared_m2_per_s2;   ///< 1 over what the square grows by until nothing drives any more
};

inline bool is_near(float speed_squared_m2_per_s2, const SpeedLimit& limit) {
  return speed_squared_m2_per_s2 > limit.from_squared_m2_per_s2;
}

/// The part of what drives the motion that has to give way, 0..1.
inline float gives_way(float speed_squared_m2_per_s2, const SpeedLimit& limit) {
  const float part = (speed_squared_m2_per_s2 - limit.from_squared_m2_per_s2) * limit.per_squared_m2_per_s2;
  if (!(part > 0.0f)) return 0.0f;
  return part < 1.0f ? part : 1.0f;
}

}  // namespace inkwell::control
