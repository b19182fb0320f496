// What a board is described by, and what is alike on all of them: clocks, rates, limits.
//
// Nothing here knows a register. The firmware programs the chip from a board's facts, the virtual board wires its
// simulated arm by them, and board/checks.hpp refuses a set that cannot work. Sections are those of RM0090 (reference
// manual) and of the STM32F405 data sheet (tables of alternate functions).
#pragma once

// To add a board:
// 1. Copy boards/bench_modules to boards/NAME. Change the facts in include/NAME/facts.hpp and the wiring in
//    README.md. board/checks.hpp refuses facts that cannot work.
// 2. Add the expected scales to tests/boards/NAME. Tests compare the facts with the wiring table of README.md.
// 3. Add the images to tests/installation/kinds.py and the folder to docs/architecture.md.
//
// The build then makes inkwell-NAME.elf, `virtual-board --board NAME` simulates the board, and
// tests/system/boards_test.cpp tests it. Another chip, or another assignment of peripherals, needs changes of the
// drivers.

#include <array>
#include <cstdint>
#include <string_view>

namespace inkwell::board {

// ---- pins ------------------------------------------------------------------------------------------

struct Pin {
  char port;            ///< 'A'..'D', 'H'
  std::uint8_t number;  ///< 0..15
  bool operator==(const Pin&) const = default;
};

/// A pin and the alternate function that connects it to its peripheral.
struct PeripheralPin {
  Pin pin;
  std::uint8_t alternate_function;
};

struct EncoderWiring {
  std::uint8_t timer;  ///< TIMx in encoder mode, channels 1 and 2
  PeripheralPin a;
  PeripheralPin b;
};

struct BridgeWiring {
  std::uint8_t channel;  ///< same channel of TIM1 (leg A) and of TIM8 (leg B)
  PeripheralPin leg_a;   ///< motor terminal +
  PeripheralPin leg_b;   ///< motor terminal -
};

struct AnalogInput {
  Pin pin;
  std::uint8_t channel;  ///< ADC channel number
};

/// What a pin is used for, by the name of its fact.
struct PinUse {
  constexpr PinUse(std::string_view fact, Pin plain) : name(fact), pin(plain), function("-") {}
  constexpr PinUse(std::string_view fact, PeripheralPin peripheral)
      : name(fact), pin(peripheral.pin), function("AF"), number(peripheral.alternate_function) {}
  constexpr PinUse(std::string_view fact, AnalogInput input)
      : name(fact), pin(input.pin), function("IN"), number(input.channel) {}

  std::string_view name;
  Pin pin;
  const char* function;  ///< "-" input or output of a port, "AF" alternate function, "IN" channel of the ADCs
  int number = -1;       ///< of the alternate function or the channel
};

// ---- clocks (RM0090, RCC) ----------------------------------------------------------------------------

inline constexpr std::uint32_t pll_input_Hz = 2'000'000;  ///< keeps the PLL's jitter low
inline constexpr std::uint32_t pll_n = 168, pll_p = 2, pll_q = 7;
inline constexpr std::uint32_t pll_vco_Hz = pll_input_Hz * pll_n;
inline constexpr std::uint32_t processor_Hz = pll_vco_Hz / pll_p;
inline constexpr std::uint32_t usb_Hz = pll_vco_Hz / pll_q;
inline constexpr std::uint32_t apb1_divider = 4, apb2_divider = 2;
inline constexpr std::uint32_t apb1_Hz = processor_Hz / apb1_divider;
inline constexpr std::uint32_t apb2_Hz = processor_Hz / apb2_divider;
inline constexpr std::uint32_t timer_apb1_Hz = 2 * apb1_Hz;  ///< TIM2 to TIM5
inline constexpr std::uint32_t timer_apb2_Hz = 2 * apb2_Hz;  ///< TIM1, TIM8
inline constexpr std::uint32_t adc_divider = 4;
inline constexpr std::uint32_t adc_Hz = apb2_Hz / adc_divider;
inline constexpr std::uint32_t flash_wait_states = 5;

static_assert(pll_vco_Hz >= 100'000'000 && pll_vco_Hz <= 432'000'000);
static_assert(processor_Hz == 168'000'000 && pll_vco_Hz % pll_p == 0);
static_assert(usb_Hz == 48'000'000 && pll_vco_Hz % pll_q == 0, "USB needs exactly 48 MHz");
static_assert(apb1_Hz <= 42'000'000 && apb2_Hz <= 84'000'000);
static_assert(adc_Hz <= 36'000'000, "limit of the ADC");

// ---- encoders ----------------------------------------------------------------------------------------
//
// Motors switch beside the encoders' wires. A level counts when so many samples in a row have seen it, one every so
// many cycles of the timer's clock (RM0090, TIMx_CCMR1, ICxF); each arm's fastest edges must leave it that time.

inline constexpr std::uint32_t encoder_filter_samples = 8, encoder_filter_divider = 4;
inline constexpr float encoder_filter_s =
    static_cast<float>(encoder_filter_samples * encoder_filter_divider) / timer_apb1_Hz;

// ---- bridges -----------------------------------------------------------------------------------------
//
// Both legs of a bridge switch at pwm_Hz, centre-aligned, with duties (1 + u) / 2 and (1 - u) / 2. The
// motor then sees pulses of one sign at twice pwm_Hz, and its current crosses its mean in the middle of
// each zero vector, which is where the timers turn round and the ADCs sample. Against locked antiphase
// at the servo rate this divides the ripple by 12.

inline constexpr std::uint32_t servo_rate_Hz = 20'000;
inline constexpr std::uint32_t pwm_periods_per_servo_period = 3;
inline constexpr std::uint32_t pwm_Hz = servo_rate_Hz * pwm_periods_per_servo_period;
inline constexpr std::uint32_t pwm_top = timer_apb2_Hz / (2 * pwm_Hz);  ///< ARR, centre-aligned
/// Update events come at both turning points, so 2 a PWM period (RM0090, repetition counter).
inline constexpr std::uint32_t pwm_repetition = 2 * pwm_periods_per_servo_period - 1;
static_assert(pwm_top * 2 * pwm_Hz == timer_apb2_Hz, "the servo rate must be exact");
static_assert(pwm_top >= 1000, "at least 10 bits of duty");
static_assert(pwm_repetition <= 255);
inline constexpr std::uint32_t servo_cycles = processor_Hz / servo_rate_Hz;

inline constexpr float supply_nominal_V = 18.0f;
inline constexpr float supply_minimum_V = 12.0f;
inline constexpr float supply_maximum_V = 24.0f;
/// Ripple of a motor's current, peak to peak, at its worst (half duty).
constexpr float current_ripple_A(float inductance_H) { return supply_nominal_V / (8.0f * pwm_Hz * inductance_H); }
/// The motors' continuous current is meant to be six times as much, or more.
inline constexpr float current_ripple_maximum_A = 0.2f;

/// A leg is never on for all of a period, so that bridges with a charge pump can refresh theirs, and so that the
/// currents are sampled before the next edge (below).
inline constexpr float duty_limit = 0.92f;
/// From an update to the edge of the shorter leg that follows it.
constexpr float time_to_next_edge_s(float duty) { return (1.0f - duty) / (4.0f * pwm_Hz); }

// ---- analogue inputs -----------------------------------------------------------------------------------

inline constexpr float adc_reference_V = 3.3f;
inline constexpr std::uint32_t adc_counts = 4096;
inline constexpr float adc_step_V = adc_reference_V / adc_counts;
inline constexpr float shunt_amplifier_offset_V = adc_reference_V / 2;  ///< output at no current

/// One injected conversion: 3 cycles of sampling and 12 of conversion. Between the update and the sampling lie at most
/// 3 cycles (data sheet, ADC characteristics, injected trigger conversion latency).
inline constexpr float injected_conversion_s = 15.0f / adc_Hz;
inline constexpr float injected_latency_s = 3.0f / adc_Hz;
inline constexpr float injected_sampling_s = 3.0f / adc_Hz;
static_assert(injected_conversion_s < 1e-6f);
static_assert(injected_latency_s + injected_sampling_s < time_to_next_edge_s(duty_limit),
              "at the largest duty the sampling would end after the next edge");

// ---- a board -------------------------------------------------------------------------------------------

/// Wires and parts in which boards differ. A board is a constant of this type under its folder's name; its README.md
/// has the same for the person who builds it.
struct Facts {
  std::string_view name;  ///< of its folder

  EncoderWiring encoders[3];
  BridgeWiring bridges[3];
  /// High lets the bridges switch, for `bridge_hold_s` after each rising edge of the heartbeat: between these two wires
  /// and the bridges stands a monostable, so that a processor that stops lets them go although it leaves the wire high.
  /// A pull-down on the board keeps them off through reset, and while the boot loader in the chip runs: it must be none
  /// of the pins that the loader pulls up or drives (AN2606).
  Pin bridge_enable;
  /// While the bridges are on it rises with each control interrupt, and falls before its end. A pin beside no leg's: an
  /// edge that comes over from there would be taken for one of its own.
  Pin bridge_heartbeat;
  /// The monostable's output, at which the bridges' enables hang too: high as long as they may switch.
  Pin bridge_hold;
  /// Open-drain fault of the bridges, low is a fault. Both pins hang on the one wire: each switches its
  /// timer's outputs off in hardware (RM0090, "Using the break function").
  PeripheralPin bridge_fault_tim1, bridge_fault_tim8;
  AnalogInput motor_current[3];  ///< ADC n converts motor n, all three at the same instant
  /// Gimbal potentiometers yaw, pitch, roll and the supply: regular sequence of ADC1.
  AnalogInput gimbal[3];
  AnalogInput supply;
  Pin button_1, button_2, inkwell_switch;  ///< switches close to ground; the pins have pull-ups
  Pin status_led;
  bool status_led_shines_when_low;
  PeripheralPin usb_minus, usb_plus;
  Pin usb_supply;  ///< high while the cable brings VBUS: PA9, where the core would sense it, drives a bridge
  PeripheralPin console_transmit, console_receive;  ///< USART2, 115200 8N1
  Pin debug_data, debug_clock;                      ///< SWDIO, SWCLK

  std::uint32_t crystal_Hz;
  float bridge_hold_s;  ///< of the monostable, by its resistor and capacitor
  /// Made by the bridge itself; the firmware does not add to it.
  float bridge_dead_time_s;
  float shunt_ohm, shunt_amplifier_gain;
  /// The amplifiers run from the converters' 3.3 V; this near to either rail their output need not follow the current
  /// any more.
  float shunt_amplifier_headroom_V;
  float supply_upper_ohm, supply_lower_ohm;  ///< the divider of the bridges' supply
  /// In front of the pins: what a channel leaves in the converter's sampling capacitor, the next one's must bear.
  float current_filter_ohm, current_filter_F, gimbal_track_ohm, gimbal_filter_F, supply_filter_F;
  /// From each current's pin to ground: a reading whose wire breaks changes by more than a current can in a control
  /// period.
  float current_pull_down_ohm;

  /// By the tolerances of the monostable and its two parts, a sixth together.
  constexpr float bridge_hold_shortest_s() const { return bridge_hold_s * 5 / 6; }
  constexpr float bridge_hold_longest_s() const { return bridge_hold_s * 7 / 6; }

  constexpr std::uint32_t pll_m() const { return crystal_Hz / pll_input_Hz; }
  /// What the dead time takes from a motor's voltage, in parts of the supply: both legs wait once in each PWM period.
  constexpr float bridge_dead_time_part() const { return 2.0f * pwm_Hz * bridge_dead_time_s; }
  constexpr float shunt_V_per_A() const { return shunt_ohm * shunt_amplifier_gain; }
  /// Positive current flows from leg A through the motor to leg B and raises the reading.
  constexpr float current_step_A() const { return adc_step_V / shunt_V_per_A(); }
  constexpr float current_range_A() const { return shunt_amplifier_offset_V / shunt_V_per_A(); }
  constexpr float current_linear_A() const {
    return (shunt_amplifier_offset_V - shunt_amplifier_headroom_V) / shunt_V_per_A();
  }
  /// A reading beyond it may be an amplifier at its rail, whatever the current is. The twentieth is for the errors of
  /// shunt, gain, amplifier offset and reference.
  constexpr float current_measurable_A() const { return 0.95f * current_linear_A(); }
  constexpr float supply_divider() const { return (supply_upper_ohm + supply_lower_ohm) / supply_lower_ohm; }
  constexpr float supply_step_V() const { return adc_step_V * supply_divider(); }

  /// One of the cable's two wires of data.
  constexpr bool is_usb_data(Pin pin) const { return pin == usb_minus.pin || pin == usb_plus.pin; }
  /// Every use, under the same names and in the same order on every board.
  constexpr std::array<PinUse, 35> pin_uses() const {
#define INKWELL_USE(fact) \
  PinUse { #fact, fact }
    return {
        INKWELL_USE(encoders[0].a),     INKWELL_USE(encoders[0].b),     INKWELL_USE(encoders[1].a),
        INKWELL_USE(encoders[1].b),     INKWELL_USE(encoders[2].a),     INKWELL_USE(encoders[2].b),
        INKWELL_USE(bridges[0].leg_a),  INKWELL_USE(bridges[0].leg_b),  INKWELL_USE(bridges[1].leg_a),
        INKWELL_USE(bridges[1].leg_b),  INKWELL_USE(bridges[2].leg_a),  INKWELL_USE(bridges[2].leg_b),
        INKWELL_USE(bridge_enable),     INKWELL_USE(bridge_heartbeat),  INKWELL_USE(bridge_hold),
        INKWELL_USE(bridge_fault_tim1), INKWELL_USE(bridge_fault_tim8), INKWELL_USE(motor_current[0]),
        INKWELL_USE(motor_current[1]),  INKWELL_USE(motor_current[2]),  INKWELL_USE(gimbal[0]),
        INKWELL_USE(gimbal[1]),         INKWELL_USE(gimbal[2]),         INKWELL_USE(supply),
        INKWELL_USE(button_1),          INKWELL_USE(button_2),          INKWELL_USE(inkwell_switch),
        INKWELL_USE(status_led),        INKWELL_USE(usb_minus),         INKWELL_USE(usb_plus),
        INKWELL_USE(usb_supply),        INKWELL_USE(console_transmit),  INKWELL_USE(console_receive),
        INKWELL_USE(debug_data),        INKWELL_USE(debug_clock),
    };
#undef INKWELL_USE
  }
};

}  // namespace inkwell::board
