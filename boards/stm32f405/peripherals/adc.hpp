// ADC1 to ADC3 (RM0090, "Analog-to-digital converter"): regular and injected groups, simultaneous and
// interleaved modes. Not modeled: alternate-trigger modes.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/adc_map.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

class Adcs;

/// VREFINT of the simulated chip. The data sheet allows 1.18 V to 1.24 V.
inline constexpr double internal_reference_V = 1.19;
/// Start-up time and shortest sampling time of VREFINT and the temperature sensor.
inline constexpr Ticks internal_source_time = 10 * (ticks_per_s / 1'000'000);
/// Factory calibration of VREFINT, in counts at VDDA = 3.3 V.
inline constexpr auto internal_reference_calibration =
    static_cast<std::uint16_t>(internal_reference_V / logic_supply_V * 4096.0);

class Adc final : public TimedPart {
 public:
  Adc(Machine& machine, Adcs& adcs, unsigned index, DmaRequests& requests, const PinFunctions& pins);
  std::string name() const { return "ADC" + std::to_string(index_ + 1); }
  void reset();
  void step(Ticks now) override;
  std::uint32_t read(std::uint32_t offset);
  void write(std::uint32_t offset, std::uint32_t value);
  std::uint32_t stored(std::uint32_t offset) const;

  /// Call this function when firmware or DMA has read the result.
  void result_taken();
  /// While `stopped` is true, the converter starts no conversions.
  void stop(bool stopped);
  bool is_on() const { return adc.cr2.adon.in(cr2_); }
  /// External trigger selection, or -1 while external triggers are off.
  int injected_trigger() const { return adc.cr2.jexten.in(cr2_) ? static_cast<int>(adc.cr2.jextsel.of(cr2_)) : -1; }
  int regular_trigger() const { return adc.cr2.exten.in(cr2_) ? static_cast<int>(adc.cr2.extsel.of(cr2_)) : -1; }
  void start_injected(Ticks now);
  void start_regular(Ticks now);
  /// In an interleaved mode, starts the regular group of a slave converter at `when`.
  void start_regular_at(Ticks when);
  unsigned regular_sampling_cycles() const { return sampling_cycles(channel_of(Group::regular, regular_rank_)); }
  /// Returns true if the processor must stop at a result of the injected group.
  bool injected_matters() const { return adc.cr1.jeocie.in(cr1_); }
  bool regular_matters() const { return adc.cr1.eocie.in(cr1_) || adc.cr2.dma.in(cr2_); }
  std::uint32_t status() const { return sr_; }
  std::uint32_t data() const { return data_; }

 private:
  enum class Group : std::uint8_t { none, regular, injected };
  enum class Phase : std::uint8_t { waiting, sampling, converting };
  unsigned regular_length() const;
  unsigned injected_length() const;
  unsigned channel_of(Group group, unsigned rank) const;
  unsigned sampling_cycles(unsigned channel) const;
  unsigned resolution_bits() const { return 12 - 2 * adc.cr1.res.of(cr1_); }
  Ticks duration(unsigned cycles) const;
  void begin_conversion(Ticks now);
  void finish_regular(Ticks now);
  void finish_injected(Ticks now);
  void check_start(Ticks now);
  std::uint32_t convert(double voltage_V) const;
  std::uint32_t sample(unsigned channel, Ticks now);
  std::uint32_t sample_internal(double volts, Ticks now);
  std::uint32_t nonsense(Ticks now) const;
  double charge(double pin_V, const AnalogSource& source, double time_s);
  void watch(unsigned channel);
  void idle();
  void update_interrupt();

  Machine& machine_;
  Adcs& adcs_;
  unsigned index_;
  DmaRequests& dma_;
  const PinFunctions& pins_;
  Timeline::Slot slot_;
  std::uint32_t sr_ = 0, cr1_ = 0, cr2_ = 0, htr_ = adc.htr.reset_value, ltr_ = 0, jsqr_ = 0, data_ = 0;
  std::array<std::uint32_t, 2> smpr_{};
  std::array<std::uint32_t, 3> sqr_{};
  std::array<std::uint32_t, 4> offset_{}, injected_data_{};
  Group group_ = Group::none;
  Phase phase_ = Phase::sampling;
  unsigned rank_ = 0, regular_rank_ = 0, injected_rank_ = 0;
  bool stopped_ = false;
  bool resume_regular_ = false, automatic_injected_ = false;
  std::uint32_t sample_ = 0;
  double sampled_V_ = 0.0;  ///< final voltage of the sampling capacitor
  Ticks stable_at_ = 0;
  Ticks began_ = 0;         ///< start of the conversion
  Ticks wake_lag_ = never;  ///< delay of the processor stop after the end of the conversion
  bool spoilt_ = false;     ///< the conversion has no valid result
};

class Adcs final : public RegisterBlock, public ConverterTriggers {
 public:
  Adcs(Machine& machine, DmaRequests& requests, const PinFunctions& pins, TimerEventUsers& timers);
  /// Sets the pointer to RCC_APB2ENR, which has one clock bit per converter.
  void clock_by(const std::uint32_t* enable_register) { enable_register_ = enable_register; }
  void reset() override;
  void timer_trigger(unsigned timer, unsigned channel) override {
    if ((connected_[timer] >> channel & 1) != 0) trigger(timer, channel);
  }
  void external_line(unsigned line) override;
  Adc& converter(unsigned index) { return adcs_[index]; }
  bool listens_to_timer(unsigned timer, unsigned channel) const override {
    return (awaited_[timer] >> channel & 1) != 0;
  }
  /// Call this function after a change of triggers or interrupts.
  void connect_triggers();
  unsigned prescaler() const { return 2 * (adc_common.ccr.adcpre.of(ccr_) + 1); }
  bool temperature_on() const { return adc_common.ccr.tsvrefe.in(ccr_); }
  /// Time at which temperature sensor and internal reference are ready.
  Ticks internal_ready_at() const { return internal_ready_at_; }
  bool battery_on() const { return adc_common.ccr.vbate.in(ccr_); }
  /// Returns true if results of regular groups use the common data register (CCR.DMA).
  bool shares_dma() const { return adc_common.ccr.dma.in(ccr_) && converts_together(); }
  /// Returns true if the converters alternate in their regular groups.
  bool interleaved() const;
  /// Shortest time between two starts of the same converter.
  Ticks interleaving_turn() const { return group_size() * interleaving_delay(); }
  /// Queues a result for the common data register.
  void share(std::uint32_t result);
  void note_injected_sequence(Ticks now);
  void start_injected(unsigned index, Ticks now);
  void start_regular(unsigned index, Ticks now);

  std::function<void(std::uint64_t index, Ticks when)> on_injected_sequence;

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::vector<RegisterMap> register_maps(const std::string& name, std::uint32_t base) const override;

 private:
  void trigger(unsigned timer, unsigned channel);
  bool is_clocked(unsigned index) const;
  bool is_slave(unsigned index, bool injected) const;
  MultiMode mode() const;
  bool injected_simultaneous() const;
  bool regular_simultaneous() const;
  bool converts_together() const { return regular_simultaneous() || interleaved(); }
  Ticks interleaving_delay() const;
  unsigned group_size() const;

  Machine& machine_;
  DmaRequests& dma_;
  TimerEventUsers& timers_;
  std::deque<Adc> adcs_;
  const std::uint32_t* enable_register_ = nullptr;
  std::uint32_t ccr_ = 0;
  Ticks internal_ready_at_ = 0;
  std::deque<std::uint32_t> shared_;  ///< results that wait for the common data register
  std::uint32_t common_data_ = 0;
  std::uint64_t injected_sequences_ = 0;
  Ticks last_injected_ = never;
  std::array<std::uint8_t, 15> connected_{}, awaited_{};
};

}  // namespace inkwell::virtual_board
