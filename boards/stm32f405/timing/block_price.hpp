// Cost of a basic block in cycles, for memory without wait states.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "boards/stm32f405/timing/costs.hpp"
#include "boards/stm32f405/timing/instruction.hpp"

namespace inkwell::virtual_board {

/// Instruction memory.
enum class CodeMemory : std::uint8_t {
  flash,          ///< separate bus, 128 bits per line
  sram,           ///< bus shared with data in SRAM
  remapped_sram,  ///< SRAM1 at address 0: instruction bus; shares the memory, but not the bus, with data in SRAM1
};

/// Price of a basic block, that is, its duration in cycles. Each execution of a block uses the same price.
struct BlockPrice {
  /// A flash access. `after_cycles` is the time of the access, relative to the start of the block.
  struct Request {
    std::uint32_t address;
    std::uint16_t after_cycles;
    bool is_data;  ///< a word read relative to the program counter; otherwise an instruction line
  };
  struct Divide {
    std::uint32_t address;
    std::uint8_t dividend, divisor;  ///< register numbers
    bool is_signed;
    bool known_at_entry;  ///< the block does not write the operands before the divide
  };
  /// Possible read of a table in the flash.
  struct Read {
    std::uint32_t instruction;  ///< address of the instruction
    std::uint16_t after_cycles;
    std::uint8_t base, index, shift;  ///< register numbers, or Instruction::no_register
    std::int32_t offset;
    bool base_at_entry, index_at_entry;  ///< the block does not write the register before the load
    std::uint32_t constant;              ///< base that the block loads from a literal; otherwise 0
  };
  std::uint32_t address = 0;
  std::uint32_t bytes = 0;
  std::uint16_t instructions = 0;
  std::uint16_t cycles = 0;              ///< with the last branch not taken and the shortest time of each divide
  std::uint16_t taken_cycles = 0;        ///< additional cycles if the last branch is taken
  std::uint16_t refill_cycles = 0;       ///< additional cycles after a branch to this block, from its word alignment
  std::uint16_t float_busy_cycles = 0;   ///< time for which an FPU division continues after the block
  std::uint16_t first_float_cycles = 0;  ///< start of the first FPU instruction, if uses_float
  bool uses_float = false;
  bool has_divides = false, has_reads = false;  ///< placed here because every run reads them
  mutable bool reads_flash = false;             ///< one of the reads has accessed the flash
  mutable std::uint32_t runs = 0;               ///< number of runs, for blocks with reads
  std::vector<Request> requests;                ///< ordered by time
  std::vector<std::uint16_t> starts;  ///< index: half-word; cycles from the start of the block to that instruction
  std::vector<Divide> divides;
  std::vector<Read> reads;
};

/// Reads a word of memory without side effects. An empty WordReader is allowed.
using WordReader = std::function<std::uint32_t(std::uint32_t address)>;

/// Returns the price of the block `code` (whole half-words) at `address`. `word` reads the literals.
BlockPrice price(std::span<const std::uint8_t> code, std::uint32_t address, CodeMemory memory, const Costs& costs,
                 const WordReader& word = {});

/// Additional cycles of a divide with unknown operands, compared with the shortest divide.
unsigned divide_mean(const Costs& costs);

/// Cycles of a divide. The rule is a guess: one additional cycle for every four quotient bits.
unsigned divide_cycles(std::uint32_t dividend, std::uint32_t divisor, bool is_signed, const Costs& costs);

}  // namespace inkwell::virtual_board
