// Bits of the timers' registers (RM0090, TIMx_CR1 ... TIMx_BDTR).
#pragma once

#include <cstdint>

namespace inkwell::virtual_board::timer_bits {

// CR1
inline constexpr std::uint32_t enable = 1u << 0, update_disable = 1u << 1, update_request_source = 1u << 2,
                               one_pulse = 1u << 3, direction = 1u << 4, reload_preload = 1u << 7;
// DIER and SR
inline constexpr std::uint32_t update_flag = 1u << 0, capture_compare_1 = 1u << 1, trigger_flag = 1u << 6,
                               break_flag = 1u << 7, overcapture_1 = 1u << 9;
inline constexpr std::uint32_t update_interrupt = 1u << 0, update_dma = 1u << 8;
// BDTR
inline constexpr std::uint32_t off_state_idle = 1u << 10, off_state_run = 1u << 11, break_enable = 1u << 12,
                               break_polarity = 1u << 13, automatic_output = 1u << 14, main_output = 1u << 15;
// CCMR: output compare modes
inline constexpr unsigned active_on_match = 1, inactive_on_match = 2, toggle_on_match = 3, force_inactive = 4,
                          force_active = 5, pwm_1 = 6, pwm_2 = 7;
// SMCR: slave modes
inline constexpr unsigned reset_mode = 4, gated = 5, trigger_mode = 6, external_clock = 7;
// CR2: master modes
inline constexpr unsigned master_reset = 0, master_enable = 1, master_update = 2, master_compare_pulse = 3;

}  // namespace inkwell::virtual_board::timer_bits
