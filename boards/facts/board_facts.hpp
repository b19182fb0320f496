// Types and common constants of board facts.
//
// The firmware and the virtual board read the facts of a board. The header checks.hpp rejects invalid facts.
#pragma once

// The following steps add a board.
//
// (1) Copy boards/bench_modules to boards/NAME. Change the facts in facts.hpp and the wiring in README.md.
// (2) Add the expected scales to tests/boards/NAME. Tests compare the facts with the wiring table of README.md.
// (3) Add the images to tests/installation/kinds.py and the folder to docs/architecture.md.
//
// The build creates inkwell-NAME.elf for the new board. `virtual-board --board NAME` simulates the board, and
// tests/system/boards_test.cpp tests the board. Another chip or another assignment of peripherals requires changes in
// the drivers.

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

struct PinUse {
  constexpr PinUse(std::string_view fact, Pin plain) : name(fact), pin(plain), function("-") {}
  constexpr PinUse(std::string_view fact, PeripheralPin peripheral)
      : name(fact), pin(peripheral.pin), function("AF"), number(peripheral.alternate_function) {}
  constexpr PinUse(std::string_view fact, AnalogInput input)
      : name(fact), pin(input.pin), function("IN"), number(input.channel) {}

  std::string_view name;
  Pin pin;
  const char* function;  ///< "-" input or output of a port, "AF" alternate function, "IN" channel of the ADCs
  int number = -1;       ///< number of the alternate function or channel
};

// ---- clocks (RM0090, RCC) ----------------------------------------------------------------------------

inline constexpr std::uint32_t pll_input_Hz = 2'000'000;  ///< keeps the PLL jitter low
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

// The motors' switching edges couple into the encoder wires. An input filter accepts a level after
// `encoder_filter_samples` equal samples. The filter samples once per `encoder_filter_divider` timer cycles (RM0090,
// TIMx_CCMR1, ICxF). For each arm, the time between two encoder edges must be longer than the filter time.

inline constexpr std::uint32_t encoder_filter_samples = 8, encoder_filter_divider = 4;
inline constexpr float encoder_filter_s =
    static_cast<float>(encoder_filter_samples * encoder_filter_divider) / timer_apb1_Hz;

// ---- bridges -----------------------------------------------------------------------------------------

// Both legs of a bridge switch at pwm_Hz with center-aligned PWM. For a relative motor voltage u, the leg duty cycles
// are (1 + u) / 2 and (1 - u) / 2. The motor voltage consists of unipolar pulses at twice pwm_Hz. In the middle of each
// zero vector, the current equals its mean. In the middle of each zero vector, the timers reverse and the ADCs sample.
// Locked antiphase PWM at the control rate would cause 12 times more ripple.

inline constexpr std::uint32_t servo_rate_Hz = 20'000;
inline constexpr std::uint32_t pwm_periods_per_servo_period = 3;
inline constexpr std::uint32_t pwm_Hz = servo_rate_Hz * pwm_periods_per_servo_period;
inline constexpr std::uint32_t pwm_top = timer_apb2_Hz / (2 * pwm_Hz);  ///< ARR, center-aligned
/// Update events occur at both counter reversals, twice per PWM period (RM0090, repetition counter).
inline constexpr std::uint32_t pwm_repetition = 2 * pwm_periods_per_servo_period - 1;
static_assert(pwm_top * 2 * pwm_Hz == timer_apb2_Hz, "the servo rate must be exact");
static_assert(pwm_top >= 1000, "at least 10 bits of duty");
static_assert(pwm_repetition <= 255);
inline constexpr std::uint32_t servo_cycles = processor_Hz / servo_rate_Hz;

inline constexpr float supply_nominal_V = 18.0f;
inline constexpr float supply_minimum_V = 12.0f;
inline constexpr float supply_maximum_V = 24.0f;
/// Worst-case peak-to-peak ripple of a motor current, at half duty.
constexpr float current_ripple_A(float inductance_H) { return supply_nominal_V / (8.0f * pwm_Hz * inductance_H); }
/// Tolerated current ripple. The continuous motor current should be at least six times the ripple.
inline constexpr float current_ripple_maximum_A = 0.2f;

/// A bridge leg is never on for a whole PWM period. Bridges with a charge pump need the off time. The off time allows
/// the ADCs to sample the currents before the next edge.
inline constexpr float duty_limit = 0.92f;
/// Shortest time from a timer update to the next edge of a bridge leg.
constexpr float time_to_next_edge_s(float duty) { return (1.0f - duty) / (4.0f * pwm_Hz); }

// ---- analog inputs ------------------------------------------------------------------------------------

inline constexpr float adc_reference_V = 3.3f;
inline constexpr std::uint32_t adc_counts = 4096;
inline constexpr float adc_step_V = adc_reference_V / adc_counts;
inline constexpr float shunt_amplifier_offset_V = adc_reference_V / 2;  ///< output at zero current

/// An injected conversion takes 3 cycles of sampling and 12 cycles of conversion. The latency from a timer update to
/// the sampling is at most 3 cycles (data sheet, ADC characteristics, injected trigger conversion latency).
inline constexpr float injected_conversion_s = 15.0f / adc_Hz;
inline constexpr float injected_latency_s = 3.0f / adc_Hz;
inline constexpr float injected_sampling_s = 3.0f / adc_Hz;
static_assert(injected_conversion_s < 1e-6f);
static_assert(injected_latency_s + injected_sampling_s < time_to_next_edge_s(duty_limit),
              "at the largest duty the sampling would end after the next edge");

// ---- a board -------------------------------------------------------------------------------------------

/// Wiring and components of one board. Each board folder defines one constant of this type.
struct Facts {
  std::string_view name;  ///< name of the folder

  EncoderWiring encoders[3];
  BridgeWiring bridges[3];
  /// A high level enables the bridges for `bridge_hold_s` after each rising edge of the heartbeat. If the processor
  /// stops while `bridge_enable` is high, a monostable disables the bridges. A pull-down on the board keeps the bridges
  /// off during reset and while the boot loader runs. The boot loader must not pull up or drive `bridge_enable`
  /// (AN2606).
  Pin bridge_enable;
  /// While the bridges are on, the heartbeat rises with each control interrupt and falls before the interrupt returns.
  /// The heartbeat pin must not be adjacent to a leg pin, because a coupled edge would count as a heartbeat.
  Pin bridge_heartbeat;
  /// The monostable output is connected to the bridge enable inputs. The bridges can switch only while the monostable
  /// output is high.
  Pin bridge_hold;
  /// Open-drain fault output of the bridges, active low. The fault wire is connected to a break input of TIM1 and to a
  /// break input of TIM8. A low level at a break input switches the timer outputs off in hardware (RM0090, "Using the
  /// break function").
  PeripheralPin bridge_fault_tim1, bridge_fault_tim8;
  AnalogInput motor_current[3];  ///< ADC n converts the current of motor n; all ADCs convert simultaneously
  /// The regular sequence of ADC1 converts the gimbal potentiometers (yaw, pitch, roll) and the supply.
  AnalogInput gimbal[3];
  AnalogInput supply;
  Pin button_1, button_2, inkwell_switch;  ///< switches to ground; the pins have pull-ups
  Pin status_led;
  bool status_led_shines_when_low;
  PeripheralPin usb_minus, usb_plus;
  Pin usb_supply;  ///< high while the cable supplies VBUS; the VBUS pin of the USB core, PA9, drives a bridge
  PeripheralPin console_transmit, console_receive;  ///< USART2, 115200 8N1
  Pin debug_data, debug_clock;                      ///< SWDIO, SWCLK

  std::uint32_t crystal_Hz;
  float bridge_hold_s;  ///< pulse width of the monostable
  /// Dead time of the bridge. The firmware adds no dead time.
  float bridge_dead_time_s;
  float shunt_ohm, shunt_amplifier_gain;
  /// Smallest voltage between the output of a shunt amplifier and its supply rails. With a smaller voltage, the output
  /// may saturate. The rails are ground and the 3.3 V supply of the converters.
  float shunt_amplifier_headroom_V;
  float supply_upper_ohm, supply_lower_ohm;  ///< voltage divider at the bridge supply
  /// Filters at the analog pins. The filters must tolerate the charge that the previous channel leaves in the sampling
  /// capacitor.
  float current_filter_ohm, current_filter_F, gimbal_track_ohm, gimbal_filter_F, supply_filter_F;
  /// Pull-down at each current input. If the wire breaks, the pull-down changes the reading faster than a real current
  /// would.
  float current_pull_down_ohm;

  /// Limits of the hold time. The tolerances of monostable, resistor and capacitor add up to one sixth.
  constexpr float bridge_hold_shortest_s() const { return bridge_hold_s * 5 / 6; }
  constexpr float bridge_hold_longest_s() const { return bridge_hold_s * 7 / 6; }

  constexpr std::uint32_t pll_m() const { return crystal_Hz / pll_input_Hz; }
  /// Voltage loss due to dead time, relative to the supply voltage. Each leg inserts one dead time per PWM period.
  constexpr float bridge_dead_time_part() const { return 2.0f * pwm_Hz * bridge_dead_time_s; }
  constexpr float shunt_V_per_A() const { return shunt_ohm * shunt_amplifier_gain; }
  /// Positive current flows from leg A through the motor to leg B and increases the reading.
  constexpr float current_step_A() const { return adc_step_V / shunt_V_per_A(); }
  constexpr float current_range_A() const { return shunt_amplifier_offset_V / shunt_V_per_A(); }
  constexpr float current_linear_A() const {
    return (shunt_amplifier_offset_V - shunt_amplifier_headroom_V) / shunt_V_per_A();
  }
  /// Above this current a shunt amplifier may be saturated. The margin of 5 % covers errors of shunt, gain, amplifier
  /// offset and reference.
  constexpr float current_measurable_A() const { return 0.95f * current_linear_A(); }
  constexpr float supply_divider() const { return (supply_upper_ohm + supply_lower_ohm) / supply_lower_ohm; }
  constexpr float supply_step_V() const { return adc_step_V * supply_divider(); }

  constexpr bool is_usb_data(Pin pin) const { return pin == usb_minus.pin || pin == usb_plus.pin; }
  /// Returns all pins in the same order for every board.
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
