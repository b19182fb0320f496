// Retains the motor heat across a restart, because a restart does not cool the motors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <control/motor_heat.hpp>

namespace inkwell::link {

/// The object is in memory that start-up does not clear, so it has no constructor. The content of this memory is
/// undefined after power-on. A restart may also interrupt a write at any word, so two slots are written alternately.
/// One of the slots is always complete.
class MotorHeatKeeper {
 public:
  /// Largest stored heat.
  static constexpr float most = 4.0f;

  /// Returns the last motor heat of the previous run. Returns nothing after power-on, or if no slot is valid. Call this
  /// function before all other functions of this class.
  std::optional<control::Warmth> start(bool power_has_come);
  /// Stores the motor heat in the older slot.
  void leave(const control::Warmth& warmth);

 private:
  struct Left {
    control::Warmth warmth;
    std::uint32_t number;  ///< increases by one per write
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
