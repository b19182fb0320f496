// Alternate functions of the pins (data sheet STM32F405, table "Alternate function mapping").
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

/// Timer signals with pins.
enum TimerLine : std::uint8_t {
  channel_1,
  channel_2,
  channel_3,
  channel_4,
  complementary_1,
  complementary_2,
  complementary_3,
  external_trigger,
  break_input,
  timer_lines,
};

struct TimerPin {
  char port;
  std::uint8_t pin;
  std::uint8_t alternate_function;
  std::uint8_t timer;
  TimerLine line;
};

// clang-format off
inline constexpr TimerPin timer_pins[] = {
    {'A', 8, 1, 1, channel_1},   {'E', 9, 1, 1, channel_1},   {'A', 9, 1, 1, channel_2},   {'E', 11, 1, 1, channel_2},
    {'A', 10, 1, 1, channel_3},  {'E', 13, 1, 1, channel_3},  {'A', 11, 1, 1, channel_4},  {'E', 14, 1, 1, channel_4},
    {'A', 7, 1, 1, complementary_1},  {'B', 13, 1, 1, complementary_1}, {'E', 8, 1, 1, complementary_1},
    {'B', 0, 1, 1, complementary_2},  {'B', 14, 1, 1, complementary_2}, {'E', 10, 1, 1, complementary_2},
    {'B', 1, 1, 1, complementary_3},  {'B', 15, 1, 1, complementary_3}, {'E', 12, 1, 1, complementary_3},
    {'A', 6, 1, 1, break_input}, {'B', 12, 1, 1, break_input}, {'E', 15, 1, 1, break_input},
    {'A', 12, 1, 1, external_trigger}, {'E', 7, 1, 1, external_trigger},
    {'A', 0, 1, 2, channel_1},   {'A', 5, 1, 2, channel_1},   {'A', 15, 1, 2, channel_1},
    {'A', 0, 1, 2, external_trigger}, {'A', 5, 1, 2, external_trigger}, {'A', 15, 1, 2, external_trigger},
    {'A', 1, 1, 2, channel_2},   {'B', 3, 1, 2, channel_2},   {'A', 2, 1, 2, channel_3},   {'B', 10, 1, 2, channel_3},
    {'A', 3, 1, 2, channel_4},   {'B', 11, 1, 2, channel_4},
    {'A', 6, 2, 3, channel_1},   {'B', 4, 2, 3, channel_1},   {'C', 6, 2, 3, channel_1},
    {'A', 7, 2, 3, channel_2},   {'B', 5, 2, 3, channel_2},   {'C', 7, 2, 3, channel_2},
    {'B', 0, 2, 3, channel_3},   {'C', 8, 2, 3, channel_3},   {'B', 1, 2, 3, channel_4},   {'C', 9, 2, 3, channel_4},
    {'D', 2, 2, 3, external_trigger},
    {'B', 6, 2, 4, channel_1},   {'D', 12, 2, 4, channel_1},  {'B', 7, 2, 4, channel_2},   {'D', 13, 2, 4, channel_2},
    {'B', 8, 2, 4, channel_3},   {'D', 14, 2, 4, channel_3},  {'B', 9, 2, 4, channel_4},   {'D', 15, 2, 4, channel_4},
    {'E', 0, 2, 4, external_trigger},
    {'A', 0, 2, 5, channel_1},   {'H', 10, 2, 5, channel_1},  {'A', 1, 2, 5, channel_2},   {'H', 11, 2, 5, channel_2},
    {'A', 2, 2, 5, channel_3},   {'H', 12, 2, 5, channel_3},  {'A', 3, 2, 5, channel_4},   {'I', 0, 2, 5, channel_4},
    {'C', 6, 3, 8, channel_1},   {'I', 5, 3, 8, channel_1},   {'C', 7, 3, 8, channel_2},   {'I', 6, 3, 8, channel_2},
    {'C', 8, 3, 8, channel_3},   {'I', 7, 3, 8, channel_3},   {'C', 9, 3, 8, channel_4},   {'I', 2, 3, 8, channel_4},
    {'A', 5, 3, 8, complementary_1},  {'A', 7, 3, 8, complementary_1},  {'H', 13, 3, 8, complementary_1},
    {'B', 0, 3, 8, complementary_2},  {'B', 14, 3, 8, complementary_2}, {'H', 14, 3, 8, complementary_2},
    {'B', 1, 3, 8, complementary_3},  {'B', 15, 3, 8, complementary_3}, {'H', 15, 3, 8, complementary_3},
    {'A', 6, 3, 8, break_input}, {'I', 4, 3, 8, break_input},
    {'A', 0, 3, 8, external_trigger}, {'I', 3, 3, 8, external_trigger},
    {'A', 2, 3, 9, channel_1},   {'E', 5, 3, 9, channel_1},   {'A', 3, 3, 9, channel_2},   {'E', 6, 3, 9, channel_2},
    {'B', 8, 3, 10, channel_1},  {'F', 6, 3, 10, channel_1},  {'B', 9, 3, 11, channel_1},  {'F', 7, 3, 11, channel_1},
    {'B', 14, 9, 12, channel_1}, {'H', 6, 9, 12, channel_1},  {'B', 15, 9, 12, channel_2}, {'H', 9, 9, 12, channel_2},
    {'A', 6, 9, 13, channel_1},  {'F', 8, 9, 13, channel_1},  {'A', 7, 9, 14, channel_1},  {'F', 9, 9, 14, channel_1},
};
// clang-format on

/// Transmit pins of the USARTs.
struct TransmitPin {
  unsigned usart;
  char port;
  std::uint8_t pin;
  std::uint8_t alternate_function;
};
inline constexpr TransmitPin transmit_pins[] = {
    {1, 'A', 9, 7}, {1, 'B', 6, 7}, {2, 'A', 2, 7},  {2, 'D', 5, 7},  {3, 'B', 10, 7}, {3, 'C', 10, 7},
    {3, 'D', 8, 7}, {4, 'A', 0, 8}, {4, 'C', 10, 8}, {5, 'C', 12, 8}, {6, 'C', 6, 8},  {6, 'G', 14, 8},
};

/// Pins of the ADCs' external channels (data sheet, pin table). ADC1 and ADC2 share their pins; ADC3 differs at
/// channels 4 to 9, 14 and 15.
struct AnalogPin {
  char port;
  std::uint8_t pin;
};
inline constexpr AnalogPin analog_pins_12[16] = {{'A', 0}, {'A', 1}, {'A', 2}, {'A', 3}, {'A', 4}, {'A', 5},
                                                 {'A', 6}, {'A', 7}, {'B', 0}, {'B', 1}, {'C', 0}, {'C', 1},
                                                 {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}};
inline constexpr AnalogPin analog_pins_3[16] = {{'A', 0}, {'A', 1}, {'A', 2},  {'A', 3}, {'F', 6}, {'F', 7},
                                                {'F', 8}, {'F', 9}, {'F', 10}, {'F', 3}, {'C', 0}, {'C', 1},
                                                {'C', 2}, {'C', 3}, {'F', 4},  {'F', 5}};

}  // namespace inkwell::virtual_board
