// Power control (RM0090, PWR). The voltage regulator is always ready.
#pragma once

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"

namespace inkwell::virtual_board {

struct PowerRegisters {
  struct : Register {
    Field lpds{"LPDS", 0}, pdds{"PDDS", 1}, cwuf{"CWUF", 2, 1, Access::w}, csbf{"CSBF", 3, 1, Access::w},
        pvde{"PVDE", 4}, pls{"PLS", 5, 3}, dbp{"DBP", 8}, fpds{"FPDS", 9}, vos{"VOS", 14};
  } cr{{"CR", 0x00, 0x4000}};
  struct : Register {
    Field pvdo{"PVDO", 2, 1, Access::r}, ewup{"EWUP", 8}, bre{"BRE", 9}, vosrdy{"VOSRDY", 14, 1, Access::r};
  } csr{{"CSR", 0x04}};
};
inline constexpr PowerRegisters pwr;

class PowerControl final : public RegisterBlock {
 public:
  PowerControl(Machine& machine, ExternalLines& external_lines, Rcc& rcc)
      : machine_(machine), external_lines_(external_lines), rcc_(rcc) {}
  void reset() override {
    control_ = pwr.cr.reset_value;
    status_ = 0;
    update_supply();
  }
  /// Updates the output of the programmable voltage detector (EXTI line 16). The falling thresholds are typical values
  /// (data sheet, V_PVD); the rising thresholds are 0.1 V higher.
  void update_supply() {
    constexpr double falling_V[] = {2.04, 2.19, 2.35, 2.51, 2.66, 2.82, 2.92, 3.03}, hysteresis_V = 0.1;
    constexpr unsigned exti_line = 16;
    const double threshold_V = falling_V[pwr.cr.pls.of(control_)] + (supply_is_low_ ? hysteresis_V : 0.0);
    supply_is_low_ = pwr.cr.pvde.in(control_) && machine_.supply_V < threshold_V;
    external_lines_.internal_line(exti_line, supply_is_low_);
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    if (offset == pwr.csr) return status_ | pwr.csr.vosrdy.mask() | pwr.csr.pvdo.with(supply_is_low_);
    return stored(offset);
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == pwr.cr) {
      control_ = value & writable(pwr.cr);
      update_supply();
      rcc_.set_voltage_scale(pwr.cr.vos.in(control_));
      if (pwr.cr.pdds.in(value)) machine_.log.say_once("PWR_CR.PDDS: standby is not modeled, and the chip only sleeps");
    }
    if (offset == pwr.csr) status_ = value & writable(pwr.csr);
  }
  std::uint32_t stored(std::uint32_t offset) const override {
    return offset == pwr.cr ? control_ : offset == pwr.csr ? status_ : 0;
  }
  std::span<const MapEntry> registers() const override { return shown<pwr>(); }

 private:
  bool supply_is_low_ = false;
  Machine& machine_;
  ExternalLines& external_lines_;
  Rcc& rcc_;
  std::uint32_t control_ = pwr.cr.reset_value, status_ = 0;
};

}  // namespace inkwell::virtual_board
