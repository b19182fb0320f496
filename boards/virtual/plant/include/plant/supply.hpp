// The supply of the bridges: a source that delivers but does not take back, its resistance, and the bulk
// capacitor, which is why the bus rises while the arm is braked.
#pragma once

#include <optional>

#include <plant/imperfections.hpp>

namespace inkwell::virtual_board {

class Supply {
 public:
  Supply(const Imperfections& imperfections, double source_V);

  void set_source_V(double volts) { source_V_ = volts; }
  /// A fault of the source: it gives this instead, until there is none.
  void fail_at_V(std::optional<double> volts) { failed_V_ = volts; }
  /// Another one: it hunts, by so much to either side and 100 times a second, and takes back what it gave before.
  void swing_by_V(double amplitude_V);
  double source_V() const;
  double bus_V() const { return bus_V_; }

  /// One step of `duration_s` in which the bridges drew `charge_As` (negative while they feed back).
  void advance(double duration_s, double charge_As);

 private:
  double source_conductance_S_, quiescent_conductance_S_, capacitance_F_;
  double source_V_, bus_V_;
  std::optional<double> failed_V_;
  double swing_V_ = 0.0, swinging_s_ = 0.0;  ///< amplitude, and for how long
};

}  // namespace inkwell::virtual_board
