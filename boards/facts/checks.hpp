// Compile-time checks of board facts. Each board instantiates Checks.
#pragma once

#include "boards/facts/board_facts.hpp"

namespace inkwell::board {
namespace detail {

constexpr bool pins_are_distinct(const Facts& facts) {
  const auto uses = facts.pin_uses();
  for (const auto& a : uses)
    for (const auto& b : uses)
      if (&a != &b && a.pin == b.pin) return false;
  return true;
}

/// The LQFP64 package has ports A, B and C, pin 2 of port D, and pins 0 and 1 of port H. Boards may use the ports A, B
/// and C.
constexpr bool package_has_pins(const Facts& facts) {
  for (const auto& use : facts.pin_uses())
    if (use.pin.port < 'A' || use.pin.port > 'C' || use.pin.number > 15) return false;
  return true;
}

/// Returns true if `input.pin` has the ADC channel `input.channel` (data sheet, pin definitions, "ADC123_INx" and
/// "ADC12_INx").
constexpr bool is_at_pin(const AnalogInput& input) {
  const auto [port, number] = input.pin;
  return (port == 'A' && number <= 7 && input.channel == number) ||
         (port == 'B' && number <= 1 && input.channel == 8 + number) ||
         (port == 'C' && number <= 5 && input.channel == 10 + number);
}
constexpr bool analog_inputs_are_at_their_pins(const Facts& facts) {
  for (unsigned i = 0; i < 3; ++i)
    if (!is_at_pin(facts.motor_current[i]) || !is_at_pin(facts.gimbal[i])) return false;
  return is_at_pin(facts.supply);
}
constexpr bool third_converter_reaches(const AnalogInput& input) {
  return input.channel <= 3 || (input.channel >= 10 && input.channel <= 13);
}

/// Returns true if the bridge legs use channels 1 to 3 of TIM1 and TIM8 (data sheet, table of alternate functions).
constexpr bool legs_are_at_their_pins(const Facts& facts) {
  unsigned channels = 0;
  for (const auto& [channel, leg_a, leg_b] : facts.bridges) {
    const auto offset = static_cast<std::uint8_t>(channel - 1);
    if (leg_a.pin != Pin{'A', static_cast<std::uint8_t>(8 + offset)} || leg_a.alternate_function != 1) return false;
    if (leg_b.pin != Pin{'C', static_cast<std::uint8_t>(6 + offset)} || leg_b.alternate_function != 3) return false;
    channels |= 1u << channel;
  }
  return channels == 0b1110;
}

}  // namespace detail

template <const Facts& facts>
struct Checks {
  static_assert(detail::pins_are_distinct(facts), "two uses of one pin");
  static_assert(detail::package_has_pins(facts), "a pin that the LQFP64 part does not have");
  static_assert(detail::legs_are_at_their_pins(facts), "a leg is where its timer's channel is not");
  static_assert(detail::analog_inputs_are_at_their_pins(facts), "a channel of the ADCs that is at another pin");
  static_assert(detail::third_converter_reaches(facts.motor_current[2]), "a channel that the third ADC does not have");

  static_assert(facts.pll_m() * pll_input_Hz == facts.crystal_Hz, "the PLL wants exactly 2 MHz of the crystal");
  static_assert(facts.crystal_Hz >= 4'000'000 && facts.crystal_Hz <= 26'000'000, "HSE (data sheet)");
  static_assert(facts.pll_m() >= 2 && facts.pll_m() <= 63);

  static_assert(facts.bridge_hold_shortest_s() > 1.25f / servo_rate_Hz &&
                    facts.bridge_hold_longest_s() < 2.0f / servo_rate_Hz,
                "the bridges would be let go between two heartbeats, or held for longer than two control periods");
  static_assert(facts.current_measurable_A() < facts.current_linear_A() &&
                facts.current_linear_A() < facts.current_range_A());
  static_assert(facts.current_pull_down_ohm > 1000 * facts.current_filter_ohm &&
                    facts.current_pull_down_ohm * facts.current_filter_F < 3.0f / servo_rate_Hz,
                "the resistor at a current's pin would change the reading, or leave it standing once its wire breaks");
  static_assert(facts.supply_divider() * adc_reference_V > supply_maximum_V + 6.0f, "over-voltage must be measurable");
};

}  // namespace inkwell::board
