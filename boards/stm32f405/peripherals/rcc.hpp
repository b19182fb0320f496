// Reset and clock control (RM0090, RCC). Oscillators have a start-up time. A clock change affects the timing of all
// parts that use this clock.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "boards/stm32f405/core/counters.hpp"
#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/memory/starting_clock.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"
#include "boards/stm32f405/peripherals/rcc_map.hpp"

namespace inkwell::virtual_board {

class Processor;

class Rcc final : public RegisterBlock, public TimedPart {
 public:
  Rcc(Machine& machine, Processor& processor, StartingClock& starting_clock, CrystalFailure& failure);

  void reset() override;
  /// Frequency of RTCCLK; 0 until the selected oscillator is ready.
  std::uint32_t real_time_clock_Hz() const;
  /// Sets the reset flags of RCC_CSR. Call this function after reset().
  void record_reset(ResetCause cause);
  /// Returns a pointer to an enable register. The bus reads the enable registers to detect peripherals without a clock.
  const std::uint32_t* enable_register(std::uint32_t offset) const { return &words_[offset / 4]; }
  void add_reset(std::uint32_t offset, std::uint32_t mask, Peripheral& peripheral) {
    resets_.push_back({offset, mask, &peripheral});
  }
  /// Starts the low-speed internal oscillator for the independent watchdog.
  void start_low_speed_internal() { words_[rcc_map.csr / 4] |= rcc_map.csr.lsion.mask(); }
  void step(Ticks now) override;
  /// Stops or restarts the crystal, for example to simulate a broken solder joint. If the crystal stops while the clock
  /// security system is on (RM0090, "Clock security system"), the chip switches to HSI, raises NMI and triggers the
  /// timer break. Without the clock security system, all parts that use the crystal stop.
  void let_crystal_swing(bool swings);
  /// Sets the deviation of the crystal from its nominal frequency.
  void drift_crystal(std::int32_t ppm);
  /// Sets PWR_CR.VOS. The highest clock frequencies require voltage scale 1.
  void set_voltage_scale(bool scale_1);

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override { return offset < bytes ? words_[offset / 4] : 0; }
  std::span<const MapEntry> registers() const override { return shown<rcc_map>(); }

 private:
  static constexpr std::uint32_t bytes = 0x90;
  enum Oscillator : unsigned { hsi, hse, pll, plli2s, lsi, lse, oscillators };
  struct ResetLine {
    std::uint32_t offset, mask;
    Peripheral* peripheral;
  };
  bool is_on(unsigned oscillator) const;
  bool is_ready(unsigned oscillator) const;
  /// Actual frequency of a clock that comes from the crystal.
  std::uint32_t real_Hz(std::uint32_t nominal_Hz) const;
  enum class PllOutput : std::uint8_t { system, usb };
  std::uint32_t pll_output_Hz(PllOutput output) const;
  void start_oscillators();
  void switch_system_clock();
  void note_enabled(std::uint32_t offset, std::uint32_t risen);
  /// Returns true if the system clock comes from the crystal, directly or through the PLL.
  bool runs_from_crystal() const;
  void lose_crystal();
  void check_limits(const Clocks& clocks) const;
  void update_tree();

  Machine& machine_;
  Processor& processor_;
  StartingClock& starting_clock_;
  CrystalFailure& failure_;
  Timeline::Slot slot_;
  std::array<std::uint32_t, bytes / 4> words_{};
  std::array<Ticks, oscillators> ready_at_{};
  unsigned system_clock_ = 0;  ///< CFGR.SWS
  std::uint32_t reset_flags_ = 0;
  Clocks nominal_{};  ///< with a crystal at its nominal frequency
  bool voltage_scale_1_ = true;
  bool crystal_swings_ = true, crystal_failed_ = false;  ///< crystal_failed_ is CIR.CSSF
  std::vector<ResetLine> resets_;
};

}  // namespace inkwell::virtual_board
