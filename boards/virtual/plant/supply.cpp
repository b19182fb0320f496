#include "boards/virtual/plant/supply.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inkwell::virtual_board {

Supply::Supply(const Imperfections& imperfections, double source_V)
    : source_conductance_S_(1.0 / imperfections.source_resistance_ohm),
      quiescent_conductance_S_(1.0 / imperfections.quiescent_resistance_ohm),
      capacitance_F_(imperfections.bulk_capacitance_F),
      source_V_(source_V),
      bus_V_(source_V) {}

void Supply::swing_by_V(double amplitude_V) {
  swing_V_ = amplitude_V;
  swinging_s_ = 0.0;
}

double Supply::source_V() const {
  constexpr double swing_Hz = 100.0;
  return failed_V_.value_or(source_V_) + swing_V_ * std::sin(2.0 * std::numbers::pi * swing_Hz * swinging_s_);
}

void Supply::advance(double duration_s, double charge_As) {
  // Implicit Euler integration is stable for all values of source resistance and capacitance.
  const auto next_V = [&](double source_S) {
    const double charge = capacitance_F_ * bus_V_ - charge_As + duration_s * source_S * source_V();
    return charge / (capacitance_F_ + duration_s * (source_S + quiescent_conductance_S_));
  };
  swinging_s_ += duration_s;
  const double fed_V = next_V(source_conductance_S_);
  // A source without oscillation does not conduct while the bus voltage exceeds the source voltage.
  bus_V_ = fed_V <= source_V() || swing_V_ != 0.0 ? fed_V : std::max(source_V(), next_V(0.0));
  // The diodes of the bridges prevent a negative bus voltage.
  bus_V_ = std::max(bus_V_, 0.0);
}

}  // namespace inkwell::virtual_board
