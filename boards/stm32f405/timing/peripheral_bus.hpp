// Wait cycles of the core for register accesses.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include "boards/stm32f405/timing/costs.hpp"

namespace inkwell::virtual_board {

/// The bridges to APB1 and APB2 handle one access at a time. During a write only the bridge is busy; during a read the
/// core also waits.
class PeripheralBus {
 public:
  explicit PeripheralBus(const Costs& costs) : costs_(costs) {}

  /// Sets HCLK, PCLK1 and PCLK2. The frequency ratios must be powers of two. A frequency of 0 means a stopped clock.
  void set_clocks(std::uint32_t hclk_Hz, std::uint32_t pclk1_Hz, std::uint32_t pclk2_Hz) {
    // The ratio is rounded, because a crystal deviation makes the frequencies inexact.
    const auto ratio = [&](std::uint32_t bus_Hz) { return bus_Hz == 0 ? 1u : (hclk_Hz + bus_Hz / 2) / bus_Hz; };
    ratios_ = {ratio(pclk1_Hz), ratio(pclk2_Hz)};
  }
  /// Additional HCLK cycles of a register access, compared with a RAM access.
  unsigned access(std::uint32_t address, bool write, std::uint64_t now) {
    constexpr std::uint32_t apb2_base = 0x4001'0000, ahb1_base = 0x4002'0000, private_base = 0xE000'0000;
    if (address >= private_base) return costs_[Cost::private_bus];
    if (address >= ahb1_base) return costs_[write ? Cost::ahb_write : Cost::ahb_read];
    const std::size_t bridge = address >= apb2_base ? 1 : 0;
    const unsigned ratio = ratios_[bridge];
    const std::uint64_t begin = std::max(now, free_at_[bridge]);
    const unsigned to_edge =
        costs_.pricing() == Pricing::conservative ? ratio - 1 : static_cast<unsigned>(0 - begin) & (ratio - 1);
    const unsigned transfer = costs_[Cost::apb_cross] + to_edge + costs_[Cost::apb_peripheral_clocks] * ratio;
    free_at_[bridge] = begin + transfer;
    return static_cast<unsigned>(begin - now) + (write ? 0 : transfer);
  }

 private:
  Costs costs_;
  std::array<unsigned, 2> ratios_{1, 1};
  std::array<std::uint64_t, 2> free_at_{};
};

}  // namespace inkwell::virtual_board
