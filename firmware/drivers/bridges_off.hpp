// Three stores switch the motors off without access to RAM.
#pragma once

#include <board/board.hpp>
#include "firmware/drivers/bridges.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

using LegsA = RegistersOf<Bridges, registers::TIM1>;
using LegsB = RegistersOf<Bridges, registers::TIM8>;

/// Value of TIMx_BDTR while the bridges are off. Idle outputs are driven low (OSSI, OSSR), and the break input is
/// active low. Lock level 1 prevents an erroneous store from disabling the break input.
inline constexpr std::uint32_t outputs_off =
    LegsA::BDTR::LOCK(1).bits | LegsA::BDTR::OSSI(1).bits | LegsA::BDTR::OSSR(1).bits | LegsA::BDTR::BKE(1).bits;

struct Store {
  std::uint32_t address;
  std::uint32_t value;
};

static_assert(board::facts.bridge_enable.port == 'B');
inline constexpr Store bridge_enable_low{registers::GPIOB::BSRR::address,
                                         1u << (board::facts.bridge_enable.number + 16)};
inline constexpr Store legs_a_off{LegsA::BDTR::address, outputs_off};
inline constexpr Store legs_b_off{LegsB::BDTR::address, outputs_off};

}  // namespace inkwell::drivers
