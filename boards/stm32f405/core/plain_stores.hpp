// Fast stores to RAM.
#pragma once

#include <bitset>
#include <cstdint>

#include "boards/stm32f405/core/engine_calls.hpp"
#include "boards/stm32f405/core/memory_map.hpp"

namespace inkwell::virtual_board {

/// Unicorn 2.0.1 treats every store to RAM as a possible change of instructions and searches for translated code. The
/// search makes stores tens of times slower than loads. Only pages with executed instructions need the search. In the
/// address cache of Unicorn, this class marks pages without executed instructions as plain.
class PlainStores {
 public:
  /// Marks pages with instructions, so that the engine checks stores to these pages.
  void code_runs_at(std::uint32_t address, std::uint32_t bytes, EngineCalls& engine) {
    const std::uint32_t end = address + bytes;
    for (std::uint32_t page = address - address % page_bytes; page < end; page += page_bytes) {
      if (page - sram_base < sram_bytes)
        mark(holds_code_, page - sram_base, engine);
      else if (page < sram1_bytes)
        mark(holds_code_at_zero_, page, engine);
    }
  }
  /// Returns true if instructions of this SRAM1 page run at the other address of the page.
  bool holds_code_at_other_address(std::uint32_t page) const {
    if (page < sram1_bytes) return holds_code_[page / page_bytes];
    return page - sram_base < sram1_bytes && holds_code_at_zero_[(page - sram_base) / page_bytes];
  }
  /// Returns true if instructions of this RAM page run at one of its addresses.
  bool holds_code(std::uint32_t address) const {
    return address - sram_base < sram_bytes && (!plain(address) || holds_code_at_other_address(address));
  }
  /// Call this function when another memory is mapped at address 0.
  void forget_code_at_zero() { holds_code_at_zero_.reset(); }
  /// Returns true if `address` is in a RAM page without executed instructions.
  bool plain(std::uint32_t address) const {
    if (address - ccm_base < ccm_bytes) return true;  // CCM is not on the instruction bus
    const std::uint32_t offset = address - sram_base;
    if (offset < sram_bytes) return !holds_code_[offset / page_bytes];
    return address < sram1_bytes && !holds_code_at_zero_[address / page_bytes];
  }

 private:
  /// The engine uses ARM pages of 1 or 4 kB.
  static constexpr std::uint32_t smallest_page_bytes = 1024, page_bytes = 4096;
  using Pages = std::bitset<sram_bytes / page_bytes>;
  static void mark(Pages& pages, std::uint32_t offset, EngineCalls& engine) {
    if (pages[offset / page_bytes]) return;
    pages.set(offset / page_bytes);
    const std::uint32_t page = offset - offset % page_bytes;
    for (std::uint32_t part = page; part < page + page_bytes; part += smallest_page_bytes) {
      engine.forget_page(sram_base + part);
      if (part < sram1_bytes) engine.forget_page(part);
    }
  }
  Pages holds_code_, holds_code_at_zero_;
};

}  // namespace inkwell::virtual_board
