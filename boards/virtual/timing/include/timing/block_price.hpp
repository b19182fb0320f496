// What a straight run of instructions costs where memory has no wait states.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <timing/costs.hpp>
#include <timing/instruction.hpp>
#include <vector>

namespace inkwell::virtual_board {

/// Which bus brings the instructions.
enum class CodeMemory : std::uint8_t {
  flash,  ///< by its own bus, 128 bits a line
  sram,   ///< by the bus that data in SRAM shares
};

/// A run that is entered at its first instruction and left after its last, priced once and used each time it runs.
struct BlockPrice {
  /// A question to the flash, in cycles since the block began.
  struct Request {
    std::uint32_t address;
    std::uint16_t after_cycles;
    bool is_data;  ///< a word that is read relative to the program counter; else a line of instructions
  };
  struct Divide {
    std::uint32_t address;
    std::uint8_t dividend, divisor;  ///< numbers of the registers
    bool is_signed;
    bool known_at_entry;  ///< nothing in the block writes the operands before
  };
  /// A load that may read the flash, as tables there are read.
  struct Read {
    std::uint32_t instruction;  ///< its address
    std::uint16_t after_cycles;
    std::uint8_t base, index, shift;  ///< numbers of the registers, Instruction::no_register for none
    std::int32_t offset;
    bool base_at_entry, index_at_entry;  ///< nothing in the block writes it before
    std::uint32_t constant;              ///< the base, if the block itself loads it from a literal; else 0
  };
  std::uint32_t address = 0;
  std::uint32_t bytes = 0;
  std::uint16_t instructions = 0;
  std::uint16_t cycles = 0;              ///< all of it: the last branch not taken, each divide its shortest
  std::uint16_t taken_cycles = 0;        ///< more if the last branch is taken
  std::uint16_t refill_cycles = 0;       ///< more if a branch led here: the first instructions cross words
  std::uint16_t float_busy_cycles = 0;   ///< how long a division of the FPU goes on after the block
  std::uint16_t first_float_cycles = 0;  ///< after which the FPU is asked, if uses_float
  bool uses_float = false;
  bool has_divides = false, has_reads = false;  ///< asked at each run, so that they stand beside what each run needs
  mutable bool reads_flash = false;             ///< one of the reads has been seen there
  mutable std::uint32_t runs = 0;               ///< of a block with reads
  std::vector<Request> requests;                ///< in the order of time
  std::vector<std::uint16_t> starts;            ///< by half word: cycles from the block's start to that instruction's
  std::vector<Divide> divides;
  std::vector<Read> reads;
};

/// Reads a word of memory without any effect; may be empty.
using WordReader = std::function<std::uint32_t(std::uint32_t address)>;

/// Prices the instructions in `code` (whole half words, as they stand in memory) at `address`. `word` tells what
/// literals hold.
BlockPrice price(std::span<const std::uint8_t> code, std::uint32_t address, CodeMemory memory, const Costs& costs,
                 const WordReader& word = {});

/// Beyond its shortest, of a divide whose operands are not known.
unsigned divide_mean(const Costs& costs);

/// Cycles of a divide (a guess: from the shortest to the longest by the quotient's bits, four a cycle).
unsigned divide_cycles(std::uint32_t dividend, std::uint32_t divisor, bool is_signed, const Costs& costs);

}  // namespace inkwell::virtual_board
