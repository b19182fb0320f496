// The chip's own supply of 3.3 V, by its voltage detector (RM0090, "Programmable voltage detector").
#pragma once

#include <registers/peripherals.hpp>

namespace inkwell::drivers {

/// After start_clocks(), which gives the detector its clock.
inline void start_logic_supply_watch() {
  using registers::PWR;
  constexpr std::uint32_t falls_at_2_92_V = 0b110;  // data sheet, V_PVD; and rises at 3.03 V
  PWR::CR::modify(PWR::CR::PLS(falls_at_2_92_V), PWR::CR::PVDE(1));
}

/// It has fallen below 2.9 V: a tenth of a volt before the brown-out reset, and the sensors' references fall with it.
inline bool logic_supply_is_low() { return registers::PWR::CSR::PVDO::is_set(); }

}  // namespace inkwell::drivers
