#include "boards/stm32f405/timing/block_price.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace inkwell::virtual_board {
namespace {

using Kind = Instruction::Kind;
constexpr std::uint32_t line_bytes = 16;
/// Size of the core's instruction prefetch buffer.
constexpr std::uint32_t fetch_buffer_bytes = 12;

unsigned base_cycles(const Instruction& it, const Costs& costs) {
  switch (it.kind) {
    case Kind::plain:
    case Kind::hint:
    case Kind::if_then:
    case Kind::load:  // additional cycles of load and store depend on the next instruction
    case Kind::store:
    case Kind::branch_immediate:
    case Kind::branch_register:
    case Kind::call:
    case Kind::float_plain:
    case Kind::float_arithmetic:
    case Kind::float_divide: return 1;
    case Kind::divide: return costs[Cost::divide_shortest];
    case Kind::multiple: return costs[Cost::multiple_base] + it.words;
    case Kind::exclusive: return costs[Cost::exclusive];
    case Kind::table_branch: return costs[Cost::table_branch] - costs[Cost::refill_load];
    case Kind::system_register: return costs[Cost::system_register];
    case Kind::barrier:
    case Kind::instruction_barrier: return costs[Cost::barrier];
    case Kind::float_accumulate: return costs[Cost::float_multiply_accumulate];
    case Kind::float_transfer: return costs[Cost::float_transfer];
    case Kind::float_multiple: return costs[Cost::float_multiple_base] + it.words;
  }
  return 1;
}

unsigned refill_cycles(const Instruction& it, CodeMemory memory, const Costs& costs) {
  const unsigned more = memory == CodeMemory::sram ? costs[Cost::sram_refill] : 0;
  if (it.loads_program_counter || it.kind == Kind::table_branch) return costs[Cost::refill_load] + more;
  if (it.kind == Kind::branch_register) return costs[Cost::refill_register] + more;
  if (it.kind == Kind::branch_immediate) return costs[Cost::refill_immediate] + more;
  return 0;
}

bool is_single_access(const Instruction& it) { return it.kind == Kind::load || it.kind == Kind::store; }

bool is_indexed_store(const Instruction& it) { return it.kind == Kind::store && it.register_offset; }

/// Returns true if `next` can start before the load `it` is complete.
bool hides_load(const Instruction& it, const Instruction& next, std::uint32_t next_address) {
  if (next.kind == Kind::hint && next.bytes == 2) return true;
  if (!is_single_access(next)) return false;
  if ((next.address_registers & it.written) != 0) return false;
  if (next.kind == Kind::store) return !next.register_offset;
  // A wide load overlaps the previous load only at a word address.
  return next.bytes == 2 || next_address % 4 == 0;
}

/// Additional cycles between two adjacent instructions.
unsigned between(const Instruction& it, const Instruction& next, std::uint32_t next_address, const Costs& costs) {
  unsigned cycles = 0;
  if (it.kind == Kind::load && !it.loads_program_counter && !hides_load(it, next, next_address))
    cycles += costs[Cost::load_stall];
  if (it.kind == Kind::store && next.kind == Kind::load) cycles += costs[Cost::store_before_load];
  if (is_indexed_store(it) && !(next.kind == Kind::hint && next.bytes == 2))
    cycles += costs[Cost::store_register_offset] - 1;
  if (next.accesses_memory && (next.address_registers & it.written) != 0 && it.kind != Kind::multiple) {
    const bool only_written_back = it.accesses_memory && it.writes_back && !it.reads_memory;
    cycles += only_written_back ? costs[Cost::same_base_written_back] : costs[Cost::address_from_previous];
  }
  // float_read excludes the addend register of a multiply-accumulate, because this register is also the destination.
  const bool latency = it.kind == Kind::float_arithmetic || it.kind == Kind::float_accumulate;
  if (latency && (next.float_read & it.float_written) != 0) cycles += costs[Cost::float_result_used_next];
  return cycles;
}

/// Models the instruction fetch from a memory without wait states. The core fetches one word per cycle into a buffer of
/// three words.
class Fetch {
 public:
  Fetch(std::uint32_t address, bool after_branch)
      : fetched_to_(after_branch ? (address & ~3u) + 4 : (address & ~3u) + fetch_buffer_bytes) {}
  /// Wait cycles until the instruction at `address` is fetched completely.
  unsigned wait_for(std::uint32_t address, std::uint32_t bytes) {
    unsigned waited = 0;
    for (; fetched_to_ < address + bytes; fetched_to_ += 4) ++waited;
    return waited;
  }
  /// Advances the fetch while an instruction executes for `cycles`. The fetch pauses for one cycle per delay.
  void run(std::uint32_t address, unsigned cycles, unsigned delays) {
    cycles -= std::min(cycles, delays);
    const std::uint32_t limit = (address & ~3u) + fetch_buffer_bytes;
    for (; cycles > 0 && fetched_to_ < limit; --cycles) fetched_to_ += 4;
  }

 private:
  std::uint32_t fetched_to_;
};

unsigned accesses_of(const Instruction& it) {
  if (!it.accesses_memory) return 0;
  return it.words != 0 ? it.words : 1;
}

/// Returns the number of cycles by which data accesses delay the instruction fetch.
unsigned fetch_delays_of(const Instruction& it, CodeMemory memory, const Costs& costs) {
  switch (memory) {
    case CodeMemory::flash: return 0;
    case CodeMemory::sram: return accesses_of(it);
    case CodeMemory::remapped_sram:
      return it.has_literal ? accesses_of(it) : accesses_of(it) * costs[Cost::remapped_data_delays_fetch];
  }
  return 0;
}

/// Counts the cycles of a block. Fills `block` unless `block` is null.
class Walk {
 public:
  Walk(std::span<const std::uint8_t> code, std::uint32_t address, CodeMemory memory, const Costs& costs,
       const WordReader& word)
      : code_(code), address_(address), memory_(memory), costs_(costs), word_(word) {}

  unsigned run(bool after_branch, BlockPrice* block) {
    Fetch fetch(address_, after_branch);
    Instruction before;
    unsigned cycle = 0, float_ready = 0, governed = 0;
    std::uint32_t line = ~0u;
    bool first = true;
    for (std::uint32_t offset = 0; offset + 2 <= code_.size();) {
      const std::uint32_t at = address_ + offset;
      const Instruction it = decode(half(offset), half(offset + 2), at);
      if (!first) cycle += between(before, it, at, costs_);
      cycle += fetch.wait_for(at, it.bytes);
      if (it.uses_float()) cycle = std::max(cycle, float_ready);
      if (block != nullptr) note(*block, it, at, cycle, line);
      unsigned own = base_cycles(it, costs_);
      // IT needs no cycle if the previous instruction is narrow.
      if (it.kind == Kind::if_then && !first && before.bytes == 2 && governed == 0) own = 0;
      if (it.kind == Kind::float_divide) float_ready = cycle + costs_[Cost::float_divide];
      fetch.run(at, own, fetch_delays_of(it, memory_, costs_));
      cycle += own;
      if (it.kind == Kind::instruction_barrier) cycle += costs_[Cost::refill_immediate];
      governed = it.kind == Kind::if_then ? it.if_then_length : governed - (governed > 0 ? 1 : 0);
      before = it;
      first = false;
      offset += it.bytes;
    }
    if (before.kind == Kind::load && !before.loads_program_counter) cycle += costs_[Cost::load_stall];
    if (is_indexed_store(before)) cycle += costs_[Cost::store_register_offset] - 1;
    if (block != nullptr) {
      block->cycles = static_cast<std::uint16_t>(cycle);
      block->taken_cycles = static_cast<std::uint16_t>(refill_cycles(before, memory_, costs_));
      block->float_busy_cycles = static_cast<std::uint16_t>(float_ready > cycle ? float_ready - cycle : 0);
    }
    return cycle;
  }

 private:
  std::uint16_t half(std::uint32_t offset) const {
    std::uint16_t value = 0;
    if (offset + 2 <= code_.size()) std::memcpy(&value, code_.data() + offset, 2);
    return value;
  }
  void note(BlockPrice& block, const Instruction& it, std::uint32_t at, unsigned cycle, std::uint32_t& line) {
    const auto now = static_cast<std::uint16_t>(cycle);
    if (memory_ == CodeMemory::flash)
      for (std::uint32_t needed : {at / line_bytes, (at + it.bytes - 1) / line_bytes})
        if (needed != line) {
          line = needed;
          block.requests.push_back({line * line_bytes, now, false});
        }
    if (it.has_literal && memory_ == CodeMemory::flash) block.requests.push_back({it.literal, now, true});
    if (it.kind == Kind::divide)
      block.divides.push_back(
          {at, it.dividend, it.divisor, it.is_signed, (written_ & (1u << it.dividend | 1u << it.divisor)) == 0});
    if (it.uses_float() && !block.uses_float) {
      block.uses_float = true;
      block.first_float_cycles = now;
    }
    if (it.reads_memory && it.base != Instruction::no_register && it.base != Instruction::stack_pointer &&
        !it.has_literal)
      note_read(block, it, at, now);
    follow_constants(it);
    written_ |= it.written;
    block.starts.resize((at - block.address) / 2 + 1, now);
    ++block.instructions;
  }

  void follow_constants(const Instruction& it) {
    const auto number = static_cast<unsigned>(std::countr_zero(it.written)) & 15;
    const std::uint32_t before = constants_[number];
    for (unsigned i = 0; i < constants_.size(); ++i)
      if ((it.written >> i & 1) != 0) constants_[i] = 0;
    if (it.kind == Kind::load && it.has_literal && word_) constants_[number] = word_(it.literal);
    if (it.constant == Instruction::Constant::whole) constants_[number] = it.literal;
    if (it.constant == Instruction::Constant::high_half) constants_[number] = it.literal << 16 | (before & 0xFFFF);
  }
  void note_read(BlockPrice& block, const Instruction& it, std::uint32_t at, std::uint16_t now) const {
    const auto at_entry = [&](std::uint8_t number) {
      return number == Instruction::no_register || (written_ >> number & 1) == 0;
    };
    block.reads.push_back({at, now, it.base, it.index, it.shift, it.offset, at_entry(it.base), at_entry(it.index),
                           at_entry(it.base) ? 0 : constants_[it.base & 15]});
  }

  std::span<const std::uint8_t> code_;
  std::uint32_t address_;
  CodeMemory memory_;
  const Costs& costs_;
  unsigned written_ = 0;                       ///< one bit per register
  std::array<std::uint32_t, 16> constants_{};  ///< literals that the block has loaded; 0: not known
  const WordReader& word_;
};

}  // namespace

BlockPrice price(std::span<const std::uint8_t> code, std::uint32_t address, CodeMemory memory, const Costs& costs,
                 const WordReader& word) {
  BlockPrice block;
  block.address = address;
  block.bytes = static_cast<std::uint32_t>(code.size());
  Walk walk(code, address, memory, costs, word);
  const unsigned cycles = walk.run(false, &block);
  block.refill_cycles = static_cast<std::uint16_t>(walk.run(true, nullptr) - cycles);
  block.has_divides = !block.divides.empty();
  block.has_reads = !block.reads.empty();
  return block;
}

unsigned divide_mean(const Costs& costs) {
  const unsigned most = costs[Cost::divide_longest] - costs[Cost::divide_shortest];
  return costs.pricing() == Pricing::conservative ? most : most / 2;
}

unsigned divide_cycles(std::uint32_t dividend, std::uint32_t divisor, bool is_signed, const Costs& costs) {
  const unsigned shortest = costs[Cost::divide_shortest], longest = costs[Cost::divide_longest];
  if (costs.pricing() == Pricing::conservative) return longest;
  const auto magnitude = [is_signed](std::uint32_t value) {
    return is_signed && value >> 31 != 0 ? 0u - value : value;
  };
  const std::uint32_t numerator = magnitude(dividend), denominator = magnitude(divisor);
  if (denominator == 0 || numerator < denominator) return shortest;
  const auto quotient_bits = static_cast<unsigned>(std::countl_zero(denominator) - std::countl_zero(numerator) + 1);
  return std::min(longest, longest - 32 / 4 + (quotient_bits + 3) / 4);
}

}  // namespace inkwell::virtual_board
