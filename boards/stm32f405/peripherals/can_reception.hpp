// Reception of a CAN controller: filter banks and two FIFOs of three frames (RM0090, "Identifier filtering",
// "Reception handling").
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "boards/stm32f405/peripherals/can_map.hpp"

namespace inkwell::virtual_board {

/// CAN frame in the format of the mailboxes.
struct CanFrame {
  std::uint32_t identifier;  ///< format of RIxR: STID, EXID, IDE, RTR
  std::uint32_t length;      ///< format of RDTxR: DLC, and FMI for received frames
  std::uint32_t low, high;
};

/// Identifier bits that a 16-bit filter compares (RM0090, "Filter bank scale configuration - register organization").
struct CanHalfFilter {
  Field exid{"EXID", 0, 3}, ide{"IDE", 3}, rtr{"RTR", 4}, stid{"STID", 5, 11};
  /// Identifier in the format of a 16-bit filter. A 16-bit filter compares only the three highest bits of EXID.
  constexpr std::uint32_t seen(std::uint32_t identifier) const {
    const auto& from = can.rir;
    return stid.with(from.stid.of(identifier)) | rtr.with(from.rtr.of(identifier)) | ide.with(from.ide.of(identifier)) |
           exid.with(from.exid.of(identifier) >> (from.exid.width - exid.width));
  }
};
inline constexpr CanHalfFilter can_half_filter;

/// Filter banks of CAN1 and CAN2. The registers of CAN1 configure all filter banks.
struct CanFilters {
  static constexpr unsigned banks = 28;
  struct Bank {
    std::uint32_t first, second;
  };
  bool initialising = true;
  unsigned first_of_second_controller = 14;
  std::uint32_t lists = 0, whole_words = 0, second_fifo = 0, active = 0;
  std::array<Bank, banks> bank{};

  struct Match {
    unsigned fifo;
    unsigned index;  ///< FMI: counts all filters of the FIFO, including inactive ones
  };
  /// Finds the matching filter with the highest priority: 32-bit before 16-bit, list before mask, low before high
  /// number.
  std::optional<Match> match(std::uint32_t identifier, unsigned controller) const {
    if (initialising) return {};
    const unsigned begin = controller == 1 ? 0 : first_of_second_controller;
    const unsigned end = controller == 1 ? std::min(first_of_second_controller, banks) : banks;
    std::array<unsigned, 2> next_index{};
    std::optional<Match> best;
    unsigned best_rank = 4;
    for (unsigned i = begin; i < end; ++i) {
      const bool is_word = can.fs1r.fsc.in(whole_words, i), is_list = can.fm1r.fbm.in(lists, i);
      const unsigned fifo = can.ffa1r.ffa.of(second_fifo, i), rank = (is_word ? 0 : 2) + (is_list ? 0 : 1);
      const unsigned first_index = next_index[fifo];
      next_index[fifo] += (is_word ? 1 : 2) * (is_list ? 2 : 1);
      if (!can.fa1r.fact.in(active, i) || rank >= best_rank) continue;
      const auto passed =
          is_word ? match_word(bank[i], identifier, is_list) : match_halves(bank[i], identifier, is_list);
      if (!passed) continue;
      best = Match{fifo, first_index + *passed};
      best_rank = rank;
    }
    return best;
  }

 private:
  static std::optional<unsigned> match_word(const Bank& of, std::uint32_t identifier, bool is_list) {
    if (!is_list) return ((identifier ^ of.first) & of.second) == 0 ? std::optional(0u) : std::nullopt;
    if (identifier == of.first) return 0;
    return identifier == of.second ? std::optional(1u) : std::nullopt;
  }
  static std::optional<unsigned> match_halves(const Bank& of, std::uint32_t identifier, bool is_list) {
    const std::uint32_t seen = can_half_filter.seen(identifier);
    unsigned index = 0;
    for (const std::uint32_t word : {of.first, of.second}) {
      const std::uint32_t low = word & 0xFFFF, high = word >> 16;
      if (!is_list) {
        if (((seen ^ low) & high) == 0) return index;
        ++index;
        continue;
      }
      if (seen == low) return index;
      if (seen == high) return index + 1;
      index += 2;
    }
    return {};
  }
};

/// Receive FIFO with its register RFxR.
class CanFifo {
 public:
  void clear() {
    frames_.clear();
    flags_ = 0;
  }
  std::uint32_t status() const { return can.rfr.fmp.with(static_cast<std::uint32_t>(frames_.size())) | flags_; }
  void write_status(std::uint32_t value) {
    flags_ &= ~(value & bits_of(can.rfr, Access::rc_w1));
    if (can.rfr.rfom.in(value) && !frames_.empty()) frames_.pop_front();
  }
  void put(const CanFrame& frame, bool locked) {
    constexpr std::size_t depth = 3;
    if (frames_.size() == depth) {
      flags_ |= can.rfr.fovr.mask();
      if (!locked) frames_.back() = frame;
      return;
    }
    frames_.push_back(frame);
    if (frames_.size() == depth) flags_ |= can.rfr.full.mask();
  }
  /// Returns RIxR, RDTxR, RDLxR or RDHxR.
  std::uint32_t word(unsigned number) const {
    if (frames_.empty()) return 0;
    const CanFrame& frame = frames_.front();
    return std::array{frame.identifier, frame.length, frame.low, frame.high}[number];
  }

 private:
  std::deque<CanFrame> frames_;
  std::uint32_t flags_ = 0;
};

}  // namespace inkwell::virtual_board
