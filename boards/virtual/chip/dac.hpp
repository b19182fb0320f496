// The two digital-to-analogue converters (RM0090, "Digital-to-analog converter"): what they hold and put out; nothing
// is connected to their pins. Waves, timers as triggers and DMA are not modelled.
#pragma once

#include "bus.hpp"

namespace inkwell::virtual_board {

struct DacRegisters {
  struct : Register {
    Field en{"EN#", 0, 1, Access::rw, {2, 16, 1}}, boff{"BOFF#", 1, 1, Access::rw, {2, 16, 1}},
        ten{"TEN#", 2, 1, Access::rw, {2, 16, 1}}, tsel{"TSEL#", 3, 3, Access::rw, {2, 16, 1}},
        wave{"WAVE#", 6, 2, Access::rw, {2, 16, 1}}, mamp{"MAMP#", 8, 4, Access::rw, {2, 16, 1}},
        dmaen{"DMAEN#", 12, 1, Access::rw, {2, 16, 1}}, dmaudrie{"DMAUDRIE#", 13, 1, Access::rw, {2, 16, 1}};
  } cr{{"CR", 0x00}};
  struct : Register {
    Field swtrig{"SWTRIG#", 0, 1, Access::w, {2, 1, 1}};
  } swtrigr{{"SWTRIGR", 0x04}};
  Register dhr12r1{"DHR12R1", 0x08}, dhr12l1{"DHR12L1", 0x0C}, dhr8r1{"DHR8R1", 0x10}, dhr12r2{"DHR12R2", 0x14},
      dhr12l2{"DHR12L2", 0x18}, dhr8r2{"DHR8R2", 0x1C}, dhr12rd{"DHR12RD", 0x20}, dhr12ld{"DHR12LD", 0x24},
      dhr8rd{"DHR8RD", 0x28};
  Register dor1{"DOR1", 0x2C}, dor2{"DOR2", 0x30};
  struct : Register {
    Field dmaudr{"DMAUDR#", 13, 1, Access::rc_w1, {2, 16, 1}};
  } sr{{"SR", 0x34}};
};
inline constexpr DacRegisters dac;

class Dac final : public RegisterBlock {
 public:
  explicit Dac(Machine& machine) : machine_(machine) {}
  void reset() override {
    control_ = 0;
    held_ = output_ = {};
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override { return stored(offset); }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    switch (offset) {
      case dac.cr:
        control_ = value & writable(dac.cr);
        if ((control_ & (dac.cr.wave.masks() | dac.cr.dmaen.masks())) != 0)
          machine_.log.say_once("DAC_CR: waves and DMA are not modelled");
        break;
      case dac.swtrigr:
        for (unsigned i = 0; i < 2; ++i)
          if (dac.swtrigr.swtrig.in(value, i)) output_[i] = held_[i];
        return;
      case dac.dhr12r1: held_[0] = value & 0xFFF; break;
      case dac.dhr12l1: held_[0] = value >> 4 & 0xFFF; break;
      case dac.dhr8r1: held_[0] = (value & 0xFF) << 4; break;
      case dac.dhr12r2: held_[1] = value & 0xFFF; break;
      case dac.dhr12l2: held_[1] = value >> 4 & 0xFFF; break;
      case dac.dhr8r2: held_[1] = (value & 0xFF) << 4; break;
      case dac.dhr12rd: held_ = {value & 0xFFF, value >> 16 & 0xFFF}; break;
      case dac.dhr12ld: held_ = {value >> 4 & 0xFFF, value >> 20 & 0xFFF}; break;
      case dac.dhr8rd: held_ = {(value & 0xFF) << 4, (value >> 8 & 0xFF) << 4}; break;
      case dac.sr: return;  // without DMA nothing underruns
      default: return machine_.log.note("DAC", offset, true, value);
    }
    for (unsigned i = 0; i < 2; ++i)
      if (!dac.cr.ten.in(control_, i)) output_[i] = held_[i];
  }
  std::uint32_t stored(std::uint32_t offset) const override {
    switch (offset) {
      case dac.cr: return control_;
      case dac.dhr12r1: return held_[0];
      case dac.dhr12l1: return held_[0] << 4;
      case dac.dhr8r1: return held_[0] >> 4;
      case dac.dhr12r2: return held_[1];
      case dac.dhr12l2: return held_[1] << 4;
      case dac.dhr8r2: return held_[1] >> 4;
      case dac.dhr12rd: return held_[0] | held_[1] << 16;
      case dac.dhr12ld: return held_[0] << 4 | held_[1] << 20;
      case dac.dhr8rd: return held_[0] >> 4 | held_[1] >> 4 << 8;
      case dac.dor1: return output_[0];
      case dac.dor2: return output_[1];
      default: return 0;
    }
  }
  std::span<const MapEntry> registers() const override { return shown<dac>(); }

 private:
  Machine& machine_;
  std::uint32_t control_ = 0;
  std::array<std::uint32_t, 2> held_{}, output_{};
};

}  // namespace inkwell::virtual_board
