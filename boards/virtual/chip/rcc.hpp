// Reset and clock control (RM0090, RCC). Oscillators take their time to start; every change of the tree
// changes the timing of everything that counts its clocks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus.hpp"

namespace inkwell::virtual_board {

class Rcc final : public RegisterBlock, public TimedPart {
 public:
  // clang-format off
  enum Register : std::uint32_t {
    cr = 0x00, pllcfgr = 0x04, cfgr = 0x08, cir = 0x0C, ahb1rstr = 0x10, ahb2rstr = 0x14, ahb3rstr = 0x18,
    apb1rstr = 0x20, apb2rstr = 0x24, ahb1enr = 0x30, ahb2enr = 0x34, ahb3enr = 0x38, apb1enr = 0x40,
    apb2enr = 0x44, bdcr = 0x70, csr = 0x74,
  };
  // clang-format on
  explicit Rcc(Machine& machine);

  void reset() override;
  /// Flags of RCC_CSR, after reset().
  void record_reset(ResetCause cause);
  /// To be looked at by the bus: a peripheral without its clock does not answer.
  const std::uint32_t* enable_register(std::uint32_t offset) const { return &words_[offset / 4]; }
  void add_reset(std::uint32_t offset, std::uint32_t mask, Peripheral& peripheral) {
    resets_.push_back({offset, mask, &peripheral});
  }
  /// The watchdog starts the low-speed oscillator by itself.
  void start_low_speed_internal() { words_[csr / 4] |= 1; }
  void step(Ticks now) override;

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override { return offset < 0x90 ? words_[offset / 4] : 0; }

 private:
  enum Oscillator : unsigned { hsi, hse, pll, plli2s, lsi, lse, oscillators };
  struct ResetLine {
    std::uint32_t offset, mask;
    Peripheral* peripheral;
  };
  bool is_on(unsigned oscillator) const;
  bool is_ready(unsigned oscillator) const;
  std::uint32_t pll_output_Hz(unsigned shift_of_divider) const;
  void start_oscillators();
  void switch_system_clock();
  void update_tree();

  Machine& machine_;
  Timeline::Slot slot_;
  std::array<std::uint32_t, 0x90 / 4> words_{};
  std::array<Ticks, oscillators> ready_at_{};
  unsigned system_clock_ = 0;  ///< CFGR.SWS
  std::uint32_t reset_flags_ = 0;
  std::vector<ResetLine> resets_;
};

}  // namespace inkwell::virtual_board
