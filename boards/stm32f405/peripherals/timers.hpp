// TIM1 to TIM14 (RM0090, "Advanced-control timers", "General-purpose timers", "Basic timers").
//
// The model does not step the counter. A ramp is the time until the next overflow or underflow. Within a ramp, the
// count is computed from board time. Steps occur only at ramp ends and at compare matches that affect another part of
// the chip. Not modeled: dead time, DMA bursts.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/alternate_functions.hpp"
#include "boards/stm32f405/peripherals/input_filter.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"
#include "boards/stm32f405/peripherals/timer_map.hpp"

namespace inkwell::virtual_board {

/// Vector table positions of a timer's interrupts (RM0090, table "Vector table").
struct TimerInterrupts {
  std::uint8_t update, capture, trigger, break_input;
  static constexpr TimerInterrupts shared(std::uint8_t position) { return {position, position, position, position}; }
};

struct TimerTraits {
  std::uint8_t number = 0;
  bool on_apb2 = false;
  std::uint8_t bits = 16;
  std::uint8_t channels = 0;
  std::uint8_t complementary = 0;  ///< channels with a complementary output
  bool repetition = false;         ///< has a repetition counter
  bool breaks = false;             ///< has a break input and a main output enable
  bool up_and_down = false;        ///< supports down-counting, center-aligned and encoder modes
  bool master = false;             ///< has a trigger output
  bool slave = false;              ///< has a trigger input
  TimerInterrupts interrupts{};
  std::array<std::uint8_t, 4> internal_triggers{};  ///< timers connected to ITR0 to ITR3
};

/// ADC trigger source for the trigger output of a timer. The ADC trigger sources 1 to 4 are the timer channels.
inline constexpr unsigned trigger_output = 0;

/// Lines from the timers to other peripherals.
struct TimerLines {
  DmaRequests& dma;
  ConverterTriggers& converters;
  TimerOutputs& outputs;
};

class Timers;

class Timer final : public RegisterBlock, public TimedPart, public ClockUser, public Freezable {
 public:
  Timer(Machine& machine, Timers& timers, const TimerLines& lines, const TimerTraits& traits);
  void reset() override;
  void step(Ticks now) override;
  void before_clock_change() override;
  void after_clock_change() override;
  /// Stops the counter. TIM1 and TIM8 switch their outputs off (RM0090, "Debug support for timers").
  void freeze(bool frozen) override;

  /// Sets the level of an input pin from `when` on.
  void input_changed(unsigned line, bool high, Ticks when);
  /// Connects a pin to this timer. The initial level is not counted as an edge.
  void connect_input(unsigned line, bool high);
  /// Triggers the break after a crystal failure (RM0090, "Using the break function").
  void clock_failed();
  /// Handles a pulse or level change of the trigger output of timer `master`.
  void internal_trigger(unsigned master, bool level, bool is_pulse);
  /// Handles a USB start of frame. TIM2 can select the USB start of frame as ITR1.
  void usb_start_of_frame();
  /// Call this function when another part of the chip starts or stops using events of this timer.
  void plan_again();
  const TimerTraits& traits() const { return traits_; }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<tim>(); }

 private:
  static constexpr std::uint64_t no_match = std::numeric_limits<std::uint64_t>::max();
  struct Channel {
    std::uint32_t compare = 0, active_compare = 0;  ///< CCRx and its active copy
    std::uint64_t match = no_match;                 ///< tick in the current ramp
    bool reference = false;                         ///< OCxREF
    bool needed = false;                            ///< another part needs the matches in time
    PinLevel when_active = PinLevel::floating, when_inactive = PinLevel::floating;
    PinLevel complement_when_active = PinLevel::floating, complement_when_inactive = PinLevel::floating;
    InputFilter input{};
    unsigned events = 0;  ///< input events since the last capture
  };
  /// External trigger, from the ETR pin to the filter output ETRF.
  struct ExternalTrigger {
    bool pin = false, level = false, divided = false;  ///< level: after ETP; divided: after ETPS
    unsigned rises = 0;
    InputFilter filter{};
  };
  /// Input number of ETR. Inputs 0 to 3 are the channels.
  static constexpr unsigned external_trigger_input = 4;

  // timer.cpp: counting
  const Clock& clock() const;
  std::uint64_t divider() const { return std::uint64_t{active_prescaler_} + 1; }
  Ticks time_of(std::uint64_t tick) const { return ramp_start_ + clock().duration(tick * divider()); }
  std::uint64_t tick_at(Ticks time) const { return clock().periods_in(time - ramp_start_, divider()); }
  std::uint32_t count_at(std::uint64_t tick) const;
  std::uint32_t count_now() const;
  bool centre_aligned() const { return tim.cr1.cms.in(cr1_); }
  bool enabled() const { return tim.cr1.cen.in(cr1_); }
  unsigned slave_mode() const { return tim.smcr.sms.of(smcr_); }
  unsigned trigger_source() const { return tim.smcr.ts.of(smcr_); }
  unsigned master_mode() const { return tim.cr2.mms.of(cr2_); }
  bool encoder_mode() const { return slave_mode() >= encoder_1 && slave_mode() <= encoder_3; }
  /// Returns true if input edges clock the counter.
  bool counts_edges() const { return encoder_mode() || slave_mode() == external_clock || tim.smcr.ece.in(smcr_); }
  bool outputs_on() const { return !traits_.breaks || (tim.bdtr.moe.in(bdtr_) && !frozen_); }
  bool runs() const;
  void settle();
  void begin_ramp(Ticks now);
  void find_matches();
  void account(std::uint64_t tick);
  void matched(unsigned channel);
  void end_ramp(Ticks now);
  bool repetitions_over();
  void update_event(bool by_software);
  void reinitialise(bool by_software);
  void count_one(bool down);
  void plan();
  Ticks update_time() const;
  bool update_needed() const;
  void trigger_out(bool level, bool is_pulse);

  // timer_outputs.cpp
  unsigned output_mode(unsigned channel) const { return tim.ccmr1.ocm.of(ccmr_[channel / 2], channel % 2); }
  unsigned selection(unsigned channel) const { return tim.ccmr1.ccs.of(ccmr_[channel / 2], channel % 2); }
  bool preloads(unsigned channel) const { return tim.ccmr1.ocpe.in(ccmr_[channel / 2], channel % 2); }
  bool compare_level(unsigned channel, std::uint32_t count) const;
  void set_reference(unsigned channel, bool level);
  void drive_outputs(unsigned channel);
  void configure_outputs();
  void configure_channel(unsigned channel);
  void check_break();
  void break_now();
  void capture(unsigned channel);
  void capture_event(unsigned channel);
  /// Captures in all channels that use the trigger TRC as input.
  void capture_by_trigger();
  bool input(unsigned channel) const { return channels_[channel].input.output(); }
  void configure_inputs();
  /// Input whose filter output changes next.
  unsigned next_input() const;
  const InputFilter& filter_of(unsigned input) const {
    return input == external_trigger_input ? external_.filter : channels_[input].input;
  }
  void take_input_changes(Ticks until);
  /// Returns true if input events can affect the processor without a read of the counter.
  bool inputs_wake() const;
  void count_encoder_edge(unsigned changed_channel);
  void drive_external_trigger(bool high, Ticks when);
  void external_edge();
  void trigger_in(bool level, bool is_pulse);
  void channel_edge(unsigned channel);

  // timer_registers.cpp

  /// Selects the master timer from TS if this timer uses a trigger.
  void listen();
  void write_control(std::uint32_t value);
  void write_events(std::uint32_t value);
  /// Register bits that LOCK currently protects.
  std::uint32_t locked_bits(std::uint32_t offset) const;
  /// Returns `value` with the locked bits of `old`.
  std::uint32_t unlocked(std::uint32_t offset, std::uint32_t old, std::uint32_t value);
  void update_interrupts();
  void raise(std::uint32_t flags);

  Machine& machine_;
  Timers& timers_;
  const TimerLines lines_;
  const TimerTraits traits_;
  Timeline::Slot slot_;
  std::uint32_t limit_;  ///< 2^bits - 1
  std::uint32_t cr1_ = 0, cr2_ = 0, smcr_ = 0, dier_ = 0, sr_ = 0, ccer_ = 0, psc_ = 0, arr_ = 0, rcr_ = 0, bdtr_ = 0,
                dcr_ = 0, or_ = 0;
  std::array<std::uint32_t, 2> ccmr_{};
  std::array<Channel, 4> channels_{};
  ExternalTrigger external_{};
  unsigned master_ = 0;  ///< the timer whose trigger output is used; 0 means none
  std::uint32_t active_prescaler_ = 0, active_reload_ = 0, repetitions_ = 0;
  std::uint32_t edges_ = 0;  ///< clock edges since the last prescaler output
  std::uint32_t count_ = 0;  ///< at the start of the ramp
  bool down_ = false;
  bool gate_open_ = false;
  bool break_input_ = false;
  bool frozen_ = false;
  Ticks ramp_start_ = 0, step_due_ = never;
  std::uint64_t ramp_length_ = 0, accounted_ = 0, next_tick_ = 0;
};

class Timers final : public TriggerLines, public TimerInputs {
 public:
  Timers(Machine& machine, const TimerLines& lines);
  Timer& timer(unsigned number) { return timers_[number - 1]; }
  void input_changed(unsigned timer_number, unsigned line, bool high, Ticks when) override {
    timer(timer_number).input_changed(line, high, when);
  }
  void connect_input(unsigned timer_number, unsigned line, bool high) override {
    timer(timer_number).connect_input(line, high);
  }
  void trigger_from(unsigned master, bool level, bool is_pulse);
  /// Returns true if the trigger output of `master` starts or steps the counter of a slave timer.
  bool has_slave(unsigned master) const { return slaves_[master] != 0; }
  /// Sets the master of `slave`; 0 means no master.
  void set_slave(unsigned slave, unsigned master);
  void plan_again();
  void clock_failed() {
    for (auto& timer : timers_) timer.clock_failed();
  }
  void usb_start_of_frame() override { timer(2).usb_start_of_frame(); }

 private:
  std::deque<Timer> timers_;
  std::array<std::uint32_t, 15> slaves_{};  ///< index: master; one bit per slave
};

}  // namespace inkwell::virtual_board
