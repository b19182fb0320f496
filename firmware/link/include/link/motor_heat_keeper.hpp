// How warm the motors are, from one run to the next: a restart cools no motor.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <control/motor_heat.hpp>

namespace inkwell::link {

/// Lies in memory that start-up does not clear, so it has no constructor. That memory holds anything after power-up,
/// and a restart may come between any two words that are written: of two places one stays whole.
class MotorHeatKeeper {
 public:
  /// More than this is kept as this.
  static constexpr float most = 4.0f;

  /// Before anything else: what the run before left last, unless the power has just come. None if nothing is sound.
  std::optional<control::Warmth> start(bool power_has_come);
  /// In place of what was left before last.
  void leave(const control::Warmth& warmth);

 private:
  struct Left {
    control::Warmth warmth;
    std::uint32_t number;  ///< one more each time
  };
  struct Place {
    Left left;
    std::uint32_t check;
  };
  static bool is_sound(const Place& place);

  std::array<Place, 2> places_;
  std::uint32_t next_number_;
};

}  // namespace inkwell::link
