// Retains the motor heat across a restart, because a restart does not cool the motors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/control/supervision/motor_heat.hpp"

namespace inkwell::link {

/// Start-up does not initialize the object, so the class has no constructor. The content of the object is undefined
/// after power-on. A restart may interrupt a write at any word, so two slots are written alternately. One of the slots
/// is always complete.
class MotorHeatKeeper {
 public:
  /// Largest stored heat.
  static constexpr float most = 4.0f;

  /// Returns the last motor heat of the previous run. Returns std::nullopt after power-on and if no slot is valid. Call
  /// this function before all other functions of this class.
  std::optional<control::Warmth> start(bool after_power_on);
  /// Stores the motor heat in the older slot.
  void store(const control::Warmth& warmth);

 private:
  struct Record {
    control::Warmth warmth;
    std::uint32_t number;  ///< increases by one per write
  };
  struct Slot {
    Record record;
    std::uint32_t check;
  };
  static bool is_valid(const Slot& slot);

  std::array<Slot, 2> slots_;
  std::uint32_t next_number_;
};

}  // namespace inkwell::link
