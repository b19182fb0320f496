// The receiving side of a CAN controller: filter banks and two FIFOs of three frames (RM0090, "Identifier filtering",
// "Reception handling").
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace inkwell::virtual_board {

/// A frame as the mailboxes have it: identifier register, length, data.
struct CanFrame {
  std::uint32_t identifier;  ///< as RIxR: STID, EXID, IDE, RTR
  std::uint32_t length;
  std::uint32_t low, high;
};

/// The filter banks of both controllers, which are CAN1's: registers FMR, FM1R, FS1R, FFA1R, FA1R and the banks.
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
    unsigned index;  ///< FMI: counts the filters of that FIFO, those that are off too
  };
  /// Whole words go before halves, lists before masks, lower numbers before higher ones.
  std::optional<Match> match(std::uint32_t identifier, unsigned controller) const {
    if (initialising) return {};
    const unsigned begin = controller == 1 ? 0 : first_of_second_controller;
    const unsigned end = controller == 1 ? std::min(first_of_second_controller, banks) : banks;
    std::array<unsigned, 2> next_index{};
    std::optional<Match> best;
    unsigned best_rank = 4;
    for (unsigned i = begin; i < end; ++i) {
      const bool is_word = bit(whole_words, i), is_list = bit(lists, i);
      const unsigned fifo = bit(second_fifo, i) ? 1 : 0, rank = (is_word ? 0 : 2) + (is_list ? 0 : 1);
      const unsigned first_index = next_index[fifo];
      next_index[fifo] += (is_word ? 1 : 2) * (is_list ? 2 : 1);
      if (!bit(active, i) || rank >= best_rank) continue;
      const auto passed =
          is_word ? match_word(bank[i], identifier, is_list) : match_halves(bank[i], identifier, is_list);
      if (!passed) continue;
      best = Match{fifo, first_index + *passed};
      best_rank = rank;
    }
    return best;
  }

 private:
  static bool bit(std::uint32_t word, unsigned number) { return (word >> number & 1) != 0; }
  static std::optional<unsigned> match_word(const Bank& of, std::uint32_t identifier, bool is_list) {
    if (!is_list) return ((identifier ^ of.first) & of.second) == 0 ? std::optional(0u) : std::nullopt;
    if (identifier == of.first) return 0;
    return identifier == of.second ? std::optional(1u) : std::nullopt;
  }
  static std::optional<unsigned> match_halves(const Bank& of, std::uint32_t identifier, bool is_list) {
    // STID, RTR, IDE and the three highest bits of EXID.
    const std::uint32_t seen =
        (identifier >> 21) << 5 | (identifier >> 1 & 1) << 4 | (identifier >> 2 & 1) << 3 | (identifier >> 18 & 7);
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

/// RFxR and what is behind it.
class CanFifo {
 public:
  static constexpr std::uint32_t pending = 3, full = 1u << 3, overrun = 1u << 4, release = 1u << 5;

  void clear() {
    frames_.clear();
    flags_ = 0;
  }
  std::uint32_t status() const { return static_cast<std::uint32_t>(frames_.size()) | flags_; }
  void write_status(std::uint32_t value) {
    flags_ &= ~(value & (full | overrun));
    if ((value & release) != 0 && !frames_.empty()) frames_.pop_front();
  }
  void put(const CanFrame& frame, bool locked) {
    constexpr std::size_t depth = 3;
    if (frames_.size() == depth) {
      flags_ |= overrun;
      if (!locked) frames_.back() = frame;
      return;
    }
    frames_.push_back(frame);
    if (frames_.size() == depth) flags_ |= full;
  }
  /// RIxR, RDTxR, RDLxR or RDHxR.
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
