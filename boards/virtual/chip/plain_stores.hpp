// Stores to RAM at the speed of loads.
#pragma once

#include <bitset>
#include <cstdint>

#include <chip/memory.hpp>
#include "engine_calls.hpp"

namespace inkwell::virtual_board {

/// Unicorn 2.0.1 takes every store to RAM for one that might overwrite instructions, and looks for translated
/// code to forget, which costs tens of times what a load costs. Only pages that instructions ran from need
/// that: of all others the engine is told, when it takes a page into its address cache, that stores are plain.
class PlainStores {
 public:
  /// Instructions are about to run from here: stores to these pages may overwrite them from now on.
  void code_runs_at(std::uint32_t address, std::uint32_t bytes, EngineCalls& engine) {
    const std::uint32_t end = address + bytes;
    for (std::uint32_t page = address - address % page_bytes; page < end; page += page_bytes) {
      const std::uint32_t offset = page - sram_base;
      if (offset >= sram_bytes || holds_code_[offset / page_bytes]) continue;
      holds_code_.set(offset / page_bytes);
      for (std::uint32_t part = 0; part < page_bytes; part += smallest_page_bytes) engine.forget_page(page + part);
    }
  }
  /// Whether the page of `address` is RAM that no instructions ran from.
  bool plain(std::uint32_t address) const {
    if (address - ccm_base < ccm_bytes) return true;  // not on the instruction bus
    const std::uint32_t offset = address - sram_base;
    return offset < sram_bytes && !holds_code_[offset / page_bytes];
  }

 private:
  /// The engine's pages for ARM have 1 or 4 kB.
  static constexpr std::uint32_t smallest_page_bytes = 1024, page_bytes = 4096;
  std::bitset<sram_bytes / page_bytes> holds_code_;
};

}  // namespace inkwell::virtual_board
