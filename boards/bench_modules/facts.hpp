// Facts of a hand-wired board with purchased modules. README.md describes the modules, the wires and the sources of the
// values.
#pragma once

#include "boards/facts/checks.hpp"

namespace inkwell::board {

inline constexpr Facts bench_modules{
    .name = "bench_modules",

    .encoders = {{5, {{'A', 0}, 2}, {{'A', 1}, 2}},
                 {3, {{'B', 4}, 2}, {{'B', 5}, 2}},
                 {4, {{'B', 6}, 2}, {{'B', 7}, 2}}},
    // The channels are in descending order, so that the wires of adjacent bridges do not cross.
    .bridges = {{3, {{'A', 10}, 1}, {{'C', 8}, 3}},
                {2, {{'A', 9}, 1}, {{'C', 7}, 3}},
                {1, {{'A', 8}, 1}, {{'C', 6}, 3}}},
    // BOOT1 must be low for the boot loader. The pull-down of the monostable keeps BOOT1 low.
    .bridge_enable = {'B', 2},
    .bridge_heartbeat = {'B', 1},
    .bridge_hold = {'B', 0},
    .bridge_fault_tim1 = {{'B', 12}, 1},
    .bridge_fault_tim8 = {{'A', 6}, 3},
    .motor_current = {{{'C', 1}, 11}, {{'C', 2}, 12}, {{'C', 3}, 13}},
    .gimbal = {{{'A', 4}, 4}, {{'A', 5}, 5}, {{'A', 7}, 7}},
    .supply = {{'C', 4}, 14},
    .button_1 = {'B', 8},
    .button_2 = {'B', 9},
    .inkwell_switch = {'B', 3},
    .status_led = {'C', 13},
    .status_led_shines_when_low = true,
    .usb_minus = {{'A', 11}, 10},
    .usb_plus = {{'A', 12}, 10},
    .usb_supply = {'C', 9},
    .console_transmit = {{'A', 2}, 7},
    .console_receive = {{'A', 3}, 7},
    .debug_data = {'A', 13},
    .debug_clock = {'A', 14},

    .crystal_Hz = 16'000'000,
    .bridge_hold_s = 82e-6f,
    .bridge_dead_time_s = 0.09e-6f,  // DRV8313 data sheet, "Output dead time"
    .shunt_ohm = 0.005f,
    .shunt_amplifier_gain = 50.0f,
    .shunt_amplifier_headroom_V = 0.2f,  // INA240 data sheet, "Swing to VS power supply rail"
    .supply_upper_ohm = 82e3f,
    .supply_lower_ohm = 10e3f,
    .current_filter_ohm = 47.0f,
    .current_filter_F = 1e-9f,
    .gimbal_track_ohm = 10e3f,
    .gimbal_filter_F = 100e-9f,
    .supply_filter_F = 100e-9f,
    .current_pull_down_ohm = 100e3f,
};
template struct Checks<bench_modules>;

}  // namespace inkwell::board
