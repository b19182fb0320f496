// Stores to RAM at the speed of loads.
#pragma once

#include <bitset>
#include <cstdint>

#include "memory.hpp"

namespace inkwell::virtual_board {

/// Unicorn 2.0.1 takes every store to RAM for one that might overwrite instructions, and looks for translated
/// code to forget, which costs tens of times what a load costs. Only pages that instructions ran from need
/// that: of all others the engine is told, when it takes a page into its address cache, that stores are plain.
///
/// The engine reaches its function that fills the address cache through the procedure linkage table, so a
/// definition in the program takes its place. With a version that lacks one of the functions all stores keep
/// their search: slower, never wrong.
class PlainStores {
 public:
  /// Instructions are about to run from here: stores to these pages may overwrite them from now on.
  void code_runs_at(std::uint32_t address, std::uint32_t bytes);
  /// Whether the page of `address` is RAM that no instructions ran from.
  bool plain(std::uint32_t address) const;

  /// While it lives, the engine that runs on this thread asks these.
  class Use {
   public:
    explicit Use(PlainStores& stores);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
  };
  /// The engine tells which processor, in its own terms, has a page in its address cache.
  void remember_processor(void* processor) { processor_ = processor; }

 private:
  /// The engine's pages for ARM have 1 or 4 kB.
  static constexpr std::uint32_t smallest_page_bytes = 1024, page_bytes = 4096;
  std::bitset<sram_bytes / page_bytes> holds_code_;
  void* processor_ = nullptr;
};

}  // namespace inkwell::virtual_board
