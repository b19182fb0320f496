// Model of the bridge supply: a voltage source, a resistor and the bulk capacitor. The source cannot sink current, so
// the bus voltage rises when the motors brake the arm.
#pragma once

#include <optional>

#include "boards/virtual/plant/imperfections.hpp"

namespace inkwell::virtual_board {

class Supply {
 public:
  Supply(const Imperfections& imperfections, double source_V);

  void set_source_V(double volts) { source_V_ = volts; }
  /// Sets the source voltage of an injected fault. std::nullopt clears the fault.
  void fail_at_V(std::optional<double> volts) { failed_V_ = volts; }
  /// Makes the source voltage oscillate at 100 Hz. An amplitude of 0 clears the fault. The oscillating source can sink
  /// current.
  void swing_by_V(double amplitude_V);
  double source_V() const;
  double bus_V() const { return bus_V_; }

  /// Advances by one time step. `charge_As` is the charge that the bridges drew, and is negative during regeneration.
  void advance(double duration_s, double charge_As);

 private:
  double source_conductance_S_, quiescent_conductance_S_, capacitance_F_;
  double source_V_, bus_V_;
  std::optional<double> failed_V_;
  double swing_V_ = 0.0, swinging_s_ = 0.0;  ///< amplitude and elapsed time
};

}  // namespace inkwell::virtual_board
