// Holding and output registers of the two digital-to-analog converters (RM0090, "Digital-to-analog converter"). Not
// modeled: pins, waveforms, timer triggers and DMA.
#pragma once

#include "boards/stm32f405/memory/register_block.hpp"

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
  // Holding registers in three formats, for each channel and for both channels.
  struct : Register {
    Field dhr{"DACC#DHR", 0, 12};
  } dhr12r{{"DHR12R#", 0x08, 0, {2, 12, 1}}};
  struct : Register {
    Field dhr{"DACC#DHR", 4, 12};
  } dhr12l{{"DHR12L#", 0x0C, 0, {2, 12, 1}}};
  struct : Register {
    Field dhr{"DACC#DHR", 0, 8};
  } dhr8r{{"DHR8R#", 0x10, 0, {2, 12, 1}}};
  struct : Register {
    Field dhr{"DACC#DHR", 0, 12, Access::rw, {2, 16, 1}};
  } dhr12rd{{"DHR12RD", 0x20}};
  struct : Register {
    Field dhr{"DACC#DHR", 4, 12, Access::rw, {2, 16, 1}};
  } dhr12ld{{"DHR12LD", 0x24}};
  struct : Register {
    Field dhr{"DACC#DHR", 0, 8, Access::rw, {2, 8, 1}};
  } dhr8rd{{"DHR8RD", 0x28}};
  struct : Register {
    Field dor{"DACC#DOR", 0, 12, Access::r};
  } dor{{"DOR#", 0x2C, 0, {2, 4, 1}}};
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
    if (offset == dac.cr) {
      control_ = value & writable(dac.cr);
      if ((control_ & (dac.cr.wave.masks() | dac.cr.dmaen.masks())) != 0)
        machine_.log.say_once("DAC_CR: waves and DMA are not modeled");
    } else if (offset == dac.swtrigr) {
      for (unsigned i = 0; i < 2; ++i)
        if (dac.swtrigr.swtrig.in(value, i)) output_[i] = held_[i];
      return;
    } else if (offset == dac.sr) {
      return;  // underrun occurs only with DMA
    } else if (!hold(offset, value)) {
      return machine_.log.note("DAC", offset, true, value);
    }
    for (unsigned i = 0; i < 2; ++i)
      if (!dac.cr.ten.in(control_, i)) output_[i] = held_[i];
  }
  std::uint32_t stored(std::uint32_t offset) const override {
    if (offset == dac.cr) return control_;
    if (dac.dor.covers(offset)) return dac.dor.dor.with(output_[dac.dor.index(offset)]);
    std::uint32_t word = 0;
    at_form(offset, [&](const Field& field, unsigned channel, unsigned index) {
      word |= field.with(held_[channel] >> (bits - field.width), index);
    });
    return word;
  }
  std::span<const MapEntry> registers() const override { return shown<dac>(); }

 private:
  static constexpr unsigned bits = 12;  ///< resolution; shorter formats have the upper bits
  /// Calls `use(field, channel, index in the field)` for each channel of a holding register. Returns false if the
  /// register is not a holding register.
  template <class Use>
  static bool at_form(std::uint32_t offset, Use use) {
    const auto of_one = [&](const auto& form) {
      if (!form.covers(offset)) return false;
      use(form.dhr, form.index(offset), 0u);
      return true;
    };
    const auto of_both = [&](const auto& form) {
      if (offset != form) return false;
      for (unsigned i = 0; i < 2; ++i) use(form.dhr, i, i);
      return true;
    };
    return of_one(dac.dhr12r) || of_one(dac.dhr12l) || of_one(dac.dhr8r) || of_both(dac.dhr12rd) ||
           of_both(dac.dhr12ld) || of_both(dac.dhr8rd);
  }
  bool hold(std::uint32_t offset, std::uint32_t value) {
    return at_form(offset, [&](const Field& field, unsigned channel, unsigned index) {
      held_[channel] = field.of(value, index) << (bits - field.width);
    });
  }

  Machine& machine_;
  std::uint32_t control_ = 0;
  std::array<std::uint32_t, 2> held_{}, output_{};
};

}  // namespace inkwell::virtual_board
