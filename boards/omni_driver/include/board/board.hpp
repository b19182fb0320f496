// The driver board as facts: pins, clocks, timers, scales and limits. README.md has the same as wires and parts.
//
// Nothing here knows a register. The firmware programs the chip from these facts, the virtual board wires
// its simulated arm by them, and static_assert refuses a set that cannot work. Sections are those of
// RM0090 (reference manual) and of the STM32F405 data sheet (tables of alternate functions).
#pragma once

#include <cstdint>
#include <string_view>

namespace inkwell::board {

/// Of this folder in boards/; an image says it (protocol/image_identity.hpp).
inline constexpr std::string_view name = "omni_driver";

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

inline constexpr EncoderWiring encoders[3] = {
    {5, {{'A', 0}, 2}, {{'A', 1}, 2}},
    {3, {{'B', 4}, 2}, {{'B', 5}, 2}},
    {4, {{'B', 6}, 2}, {{'B', 7}, 2}},
};

inline constexpr BridgeWiring bridges[3] = {
    {1, {{'A', 8}, 1}, {{'C', 6}, 3}},
    {2, {{'A', 9}, 1}, {{'C', 7}, 3}},
    {3, {{'A', 10}, 1}, {{'C', 8}, 3}},
};

/// High lets the bridges switch. A pull-down on the board keeps them off through reset, and while the boot loader in
/// the chip runs: it must be none of the pins that the loader pulls up or drives (AN2606).
inline constexpr Pin bridge_enable{'B', 1};
/// Open-drain fault of the bridges, low is a fault. Both pins hang on the one wire: each switches its
/// timer's outputs off in hardware (RM0090, "Using the break function").
inline constexpr PeripheralPin bridge_fault_tim1{{'B', 12}, 1};
inline constexpr PeripheralPin bridge_fault_tim8{{'A', 6}, 3};

/// Motor currents: ADC n converts motor n, all three at the same instant.
inline constexpr AnalogInput motor_current[3] = {{{'C', 0}, 10}, {{'C', 1}, 11}, {{'C', 2}, 12}};
/// Gimbal potentiometers yaw, pitch, roll and the supply: regular sequence of ADC1.
inline constexpr AnalogInput gimbal[3] = {{{'C', 3}, 13}, {{'C', 4}, 14}, {{'C', 5}, 15}};
inline constexpr AnalogInput supply{{'B', 0}, 8};

/// Switches close to ground; the pins have pull-ups.
inline constexpr Pin button_1{'B', 13};
inline constexpr Pin button_2{'B', 14};
inline constexpr Pin inkwell_switch{'B', 15};

inline constexpr Pin status_led{'C', 10};
inline constexpr PeripheralPin usb_minus{{'A', 11}, 10};
inline constexpr PeripheralPin usb_plus{{'A', 12}, 10};
/// High while the cable brings VBUS: PA9, where the core would sense it, drives a bridge.
inline constexpr Pin usb_supply{'C', 12};
inline constexpr PeripheralPin console_transmit{{'A', 2}, 7};  ///< USART2, 115200 8N1
inline constexpr PeripheralPin console_receive{{'A', 3}, 7};
inline constexpr Pin debug_data{'A', 13};   ///< SWDIO
inline constexpr Pin debug_clock{'A', 14};  ///< SWCLK

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

#define INKWELL_USE(fact) \
  PinUse { #fact, fact }
inline constexpr PinUse pin_uses[] = {
    INKWELL_USE(encoders[0].a),    INKWELL_USE(encoders[0].b),     INKWELL_USE(encoders[1].a),
    INKWELL_USE(encoders[1].b),    INKWELL_USE(encoders[2].a),     INKWELL_USE(encoders[2].b),
    INKWELL_USE(bridges[0].leg_a), INKWELL_USE(bridges[0].leg_b),  INKWELL_USE(bridges[1].leg_a),
    INKWELL_USE(bridges[1].leg_b), INKWELL_USE(bridges[2].leg_a),  INKWELL_USE(bridges[2].leg_b),
    INKWELL_USE(bridge_enable),    INKWELL_USE(bridge_fault_tim1), INKWELL_USE(bridge_fault_tim8),
    INKWELL_USE(motor_current[0]), INKWELL_USE(motor_current[1]),  INKWELL_USE(motor_current[2]),
    INKWELL_USE(gimbal[0]),        INKWELL_USE(gimbal[1]),         INKWELL_USE(gimbal[2]),
    INKWELL_USE(supply),           INKWELL_USE(button_1),          INKWELL_USE(button_2),
    INKWELL_USE(inkwell_switch),   INKWELL_USE(status_led),        INKWELL_USE(usb_minus),
    INKWELL_USE(usb_plus),         INKWELL_USE(usb_supply),        INKWELL_USE(console_transmit),
    INKWELL_USE(console_receive),  INKWELL_USE(debug_data),        INKWELL_USE(debug_clock),
};
#undef INKWELL_USE

/// One of the cable's two wires of data.
constexpr bool is_usb_data(Pin pin) { return pin == usb_minus.pin || pin == usb_plus.pin; }

namespace detail {
constexpr bool pins_are_distinct() {
  for (const auto& a : pin_uses)
    for (const auto& b : pin_uses)
      if (&a != &b && a.pin == b.pin) return false;
  return true;
}
/// The LQFP64 part has ports A, B and C whole, D only pin 2 and H only pins 0 and 1.
constexpr bool package_has_pins() {
  for (const auto& use : pin_uses)
    if (use.pin.port < 'A' || use.pin.port > 'C' || use.pin.number > 15) return false;
  return true;
}
}  // namespace detail
static_assert(detail::pins_are_distinct(), "two uses of one pin");
static_assert(detail::package_has_pins(), "a pin that the LQFP64 part does not have");

// ---- clocks (RM0090, RCC) ----------------------------------------------------------------------------

inline constexpr std::uint32_t crystal_Hz = 8'000'000;
inline constexpr std::uint32_t pll_m = 4, pll_n = 168, pll_p = 2, pll_q = 7;
inline constexpr std::uint32_t pll_input_Hz = crystal_Hz / pll_m;
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

static_assert(pll_input_Hz == 2'000'000, "2 MHz keeps the PLL's jitter low");
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
/// Made by the bridge itself; the firmware does not add to it.
inline constexpr float bridge_dead_time_s = 0.2e-6f;
/// What it takes from a motor's voltage, in parts of the supply: both legs wait once in each PWM period.
inline constexpr float bridge_dead_time_part = 2.0f * pwm_Hz * bridge_dead_time_s;

// ---- analogue scales ---------------------------------------------------------------------------------

inline constexpr float adc_reference_V = 3.3f;
inline constexpr std::uint32_t adc_counts = 4096;
inline constexpr float adc_step_V = adc_reference_V / adc_counts;

inline constexpr float shunt_ohm = 0.020f;
inline constexpr float shunt_amplifier_gain = 20.0f;
inline constexpr float shunt_amplifier_offset_V = adc_reference_V / 2;  ///< output at no current
/// Positive current flows from leg A through the motor to leg B and raises the reading.
inline constexpr float current_step_A = adc_step_V / (shunt_ohm * shunt_amplifier_gain);
inline constexpr float current_range_A = shunt_amplifier_offset_V / (shunt_ohm * shunt_amplifier_gain);
/// The amplifiers run from the converters' 3.3 V; this near to either rail their output need not follow the current any
/// more (INA240 data sheet, "Swing to VS power supply rail").
inline constexpr float shunt_amplifier_headroom_V = 0.2f;
inline constexpr float current_linear_A =
    (shunt_amplifier_offset_V - shunt_amplifier_headroom_V) / (shunt_ohm * shunt_amplifier_gain);
/// A reading beyond it may be an amplifier at its rail, whatever the current is. The twentieth is for the errors of
/// shunt, gain, amplifier offset and reference.
inline constexpr float current_measurable_A = 0.95f * current_linear_A;
static_assert(current_measurable_A < current_linear_A && current_linear_A < current_range_A);

inline constexpr float supply_upper_ohm = 100e3f, supply_lower_ohm = 10e3f;
inline constexpr float supply_divider = (supply_upper_ohm + supply_lower_ohm) / supply_lower_ohm;
inline constexpr float supply_step_V = adc_step_V * supply_divider;
static_assert(supply_divider * adc_reference_V > supply_maximum_V + 6.0f, "over-voltage must be measurable");

/// In front of the pins: what a channel leaves in the converter's sampling capacitor, the next one's must bear.
inline constexpr float current_filter_ohm = 47.0f, current_filter_F = 1e-9f;
inline constexpr float gimbal_track_ohm = 10e3f, gimbal_filter_F = 100e-9f, supply_filter_F = 100e-9f;

/// One injected conversion: 3 cycles of sampling and 12 of conversion. Between the update and the sampling lie at most
/// 3 cycles (data sheet, ADC characteristics, injected trigger conversion latency).
inline constexpr float injected_conversion_s = 15.0f / adc_Hz;
inline constexpr float injected_latency_s = 3.0f / adc_Hz;
inline constexpr float injected_sampling_s = 3.0f / adc_Hz;
static_assert(injected_conversion_s < 1e-6f);
static_assert(injected_latency_s + injected_sampling_s < time_to_next_edge_s(duty_limit),
              "at the largest duty the sampling would end after the next edge");

}  // namespace inkwell::board
