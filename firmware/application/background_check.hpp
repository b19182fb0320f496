// Checks of memory, supplies and wires in the main loop. The control interrupt has no spare cycles for these checks.
// The results of these checks may be two control periods late. The CPU supply needs a faster reaction and has a
// separate interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <board/board.hpp>
#include "firmware/control/supervision/analog_supply.hpp"
#include "firmware/control/supervision/bridge_wire.hpp"
#include "firmware/control/supervision/encoder_wire.hpp"
#include "firmware/control/supervision/stuck_encoder.hpp"
#include "firmware/control/supervision/supply_ripple.hpp"
#include "protocol/supervision.hpp"

#include "firmware/application/memory_check.hpp"

namespace inkwell::application {

class BackgroundCheck {
 public:
  /// Checks the whole memory. Call this function after the drivers have started and before a motor can be driven.
  /// Returns false if a memory bit is wrong.
  bool start();

  /// Call this function in each round of the main loop, at most once per control period. The control interrupt reads
  /// the results.
  void run();

  const control::AnalogSupply& analog_supply() const { return analog_supply_; }

 private:
  static constexpr unsigned rounds_per_check = 3;

  void report(protocol::Conditions found);
  protocol::Conditions supply_faults();
  protocol::Conditions encoder_faults();
  bool detect_stuck_encoders();
  protocol::Conditions bridge_faults();

  MemoryCheck memory_check_;
  control::SupplyRipple supply_ripple_{
      .tolerance_counts = static_cast<std::int32_t>(protocol::supply_ripple_V / board::facts.supply_step_V())};
  control::AnalogSupply analog_supply_;
  std::array<control::EncoderWire, 3> encoder_wires_{};
  std::array<control::StuckEncoder, 3> stuck_encoders_{};
  control::BridgeWire bridge_wire_;
  unsigned rounds_ = 0;  ///< main loop rounds since the last check
};

}  // namespace inkwell::application
