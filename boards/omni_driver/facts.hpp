// Facts of the driver board: pins, crystal, scales. README.md describes the wiring and parts.
#pragma once

#include "boards/facts/checks.hpp"

namespace inkwell::board {

inline constexpr Facts omni_driver{
    .name = "omni_driver",

    .encoders = {{5, {{'A', 0}, 2}, {{'A', 1}, 2}},
                 {3, {{'B', 4}, 2}, {{'B', 5}, 2}},
                 {4, {{'B', 6}, 2}, {{'B', 7}, 2}}},
    .bridges = {{1, {{'A', 8}, 1}, {{'C', 6}, 3}},
                {2, {{'A', 9}, 1}, {{'C', 7}, 3}},
                {3, {{'A', 10}, 1}, {{'C', 8}, 3}}},
    .bridge_enable = {'B', 1},
    .bridge_heartbeat = {'B', 9},
    .bridge_hold = {'B', 8},
    .bridge_fault_tim1 = {{'B', 12}, 1},
    .bridge_fault_tim8 = {{'A', 6}, 3},
    .motor_current = {{{'C', 0}, 10}, {{'C', 1}, 11}, {{'C', 2}, 12}},
    .gimbal = {{{'C', 3}, 13}, {{'C', 4}, 14}, {{'C', 5}, 15}},
    .supply = {{'B', 0}, 8},
    .button_1 = {'B', 13},
    .button_2 = {'B', 14},
    .inkwell_switch = {'B', 15},
    .status_led = {'C', 10},
    .status_led_shines_when_low = false,
    .usb_minus = {{'A', 11}, 10},
    .usb_plus = {{'A', 12}, 10},
    .usb_supply = {'C', 12},
    .console_transmit = {{'A', 2}, 7},
    .console_receive = {{'A', 3}, 7},
    .debug_data = {'A', 13},
    .debug_clock = {'A', 14},

    .crystal_Hz = 8'000'000,
    .bridge_hold_s = 82e-6f,
    .bridge_dead_time_s = 0.2e-6f,
    .shunt_ohm = 0.020f,
    .shunt_amplifier_gain = 20.0f,
    .shunt_amplifier_headroom_V = 0.2f,  // INA240 data sheet, "Swing to VS power supply rail"
    .supply_upper_ohm = 100e3f,
    .supply_lower_ohm = 10e3f,
    .current_filter_ohm = 47.0f,
    .current_filter_F = 1e-9f,
    .gimbal_track_ohm = 10e3f,
    .gimbal_filter_F = 100e-9f,
    .supply_filter_F = 100e-9f,
    .current_pull_down_ohm = 100e3f,
};
template struct Checks<omni_driver>;

}  // namespace inkwell::board
