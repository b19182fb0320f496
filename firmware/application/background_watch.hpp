// What the main loop watches, beside the control interrupt: memory, supplies and wires. None of it is so quick that a
// control period or two would matter, and the interrupt has no cycles to give. (The chip's own supply is: it
// interrupts, and is looked at here for as long as it is low.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <board/board.hpp>
#include <control/analog_supply.hpp>
#include <control/bridge_wire.hpp>
#include <control/encoder_wire.hpp>
#include <control/stuck_encoder.hpp>
#include <control/supply_ripple.hpp>
#include <protocol/supervision.hpp>

#include "memory_check.hpp"

namespace inkwell::application {

class BackgroundWatch {
 public:
  /// Goes through the whole memory, before anything that is damaged can drive a motor. The drivers must have started.
  /// False if a bit of the memory is wrong.
  bool start();

  /// Call it each time that the main loop comes round, once in a control period at most. What is found goes to the
  /// control interrupt.
  void look();

  /// What is known of VDDA.
  const control::AnalogSupply& analog_supply() const { return analog_supply_; }

 private:
  static constexpr unsigned rounds_per_look = 3;

  void tell(protocol::Watches found);
  protocol::Watches found_of_supplies();
  protocol::Watches found_of_encoders();
  bool an_encoder_is_stuck();
  protocol::Watches found_of_bridges();

  MemoryCheck memory_check_;
  control::SupplyRipple supply_ripple_{
      .bearable_counts = static_cast<std::int32_t>(protocol::supply_ripple_V / board::facts.supply_step_V())};
  control::AnalogSupply analog_supply_;
  std::array<control::EncoderWire, 3> encoder_wires_{};
  std::array<control::StuckEncoder, 3> stuck_encoders_{};
  control::BridgeWire bridge_wire_;
  unsigned rounds_ = 0;  ///< of the main loop, since the last look
};

}  // namespace inkwell::application
