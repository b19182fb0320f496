// Reset and clock control (RM0090, RCC). Oscillators take their time to start; every change of the tree
// changes the timing of everything that counts its clocks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus.hpp"
#include "rcc_map.hpp"

namespace inkwell::virtual_board {

class Rcc final : public RegisterBlock, public TimedPart {
 public:
  explicit Rcc(Machine& machine);

  void reset() override;
  /// Flags of RCC_CSR, after reset().
  /// What RCC_BDCR gives the real-time clock, once its oscillator is ready; otherwise 0.
  std::uint32_t real_time_clock_Hz() const;
  void record_reset(ResetCause cause);
  /// To be looked at by the bus: a peripheral without its clock does not answer.
  const std::uint32_t* enable_register(std::uint32_t offset) const { return &words_[offset / 4]; }
  void add_reset(std::uint32_t offset, std::uint32_t mask, Peripheral& peripheral) {
    resets_.push_back({offset, mask, &peripheral});
  }
  /// The watchdog starts the low-speed oscillator by itself.
  void start_low_speed_internal() { words_[rcc_map.csr / 4] |= rcc_map.csr.lsion.mask(); }
  /// The clock of a peripheral has been switched on so lately that it has not arrived there.
  bool is_fresh(const std::uint32_t* enable, std::uint32_t mask, std::uint64_t cycle) const {
    return cycle < fresh_until_ && enable == &words_[fresh_offset_ / 4] && (fresh_mask_ & mask) != 0;
  }
  void step(Ticks now) override;
  /// A crystal that stops, as with a broken joint, or swings again. With the clock security system on (RM0090, "Clock
  /// security system") the chip goes on with HSI, NMI comes and the timers break; without it what runs from the crystal
  /// stands still.
  void let_crystal_swing(bool swings);
  /// How much faster than its name it swings, from now on.
  void drift_crystal(std::int32_t ppm);
  /// PWR_CR.VOS: scale 1 is for the highest clocks.
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
  /// Of a clock that comes from the crystal, what it really is.
  std::uint32_t real_Hz(std::uint32_t nominal_Hz) const;
  enum class PllOutput : std::uint8_t { system, usb };
  std::uint32_t pll_output_Hz(PllOutput output) const;
  void start_oscillators();
  void switch_system_clock();
  void note_enabled(std::uint32_t offset, std::uint32_t risen);
  /// The system clock comes from the crystal, through the PLL or not.
  bool runs_from_crystal() const;
  void lose_crystal();
  void check_limits(const Clocks& clocks) const;
  void update_tree();

  Machine& machine_;
  Timeline::Slot slot_;
  std::array<std::uint32_t, bytes / 4> words_{};
  std::array<Ticks, oscillators> ready_at_{};
  unsigned system_clock_ = 0;  ///< CFGR.SWS
  std::uint32_t reset_flags_ = 0;
  Clocks nominal_{};  ///< with a crystal that swings as it should
  bool voltage_scale_1_ = true;
  bool crystal_swings_ = true, crystal_failed_ = false;  ///< the latter: CIR.CSSF
  std::uint64_t fresh_until_ = 0;                        ///< cycle of the core
  std::uint32_t fresh_offset_ = 0, fresh_mask_ = 0;
  std::vector<ResetLine> resets_;
};

}  // namespace inkwell::virtual_board
