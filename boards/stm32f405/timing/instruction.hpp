// Duration-related properties of a Thumb-2 instruction (ARMv7-M Architecture Reference Manual, A5).
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

struct Instruction {
  enum class Kind : std::uint8_t {
    plain,     ///< one cycle in the integer pipeline
    hint,      ///< NOP and other hints, which may be hidden by the stall of a load
    if_then,   ///< IT
    divide,    ///< SDIV, UDIV
    load,      ///< one register
    store,     ///< one register
    multiple,  ///< several registers or a pair
    exclusive,
    branch_immediate,
    branch_register,
    table_branch,
    system_register,
    barrier,
    instruction_barrier,
    call,              ///< SVC, BKPT, UDF, which raise an exception
    float_plain,       ///< without arithmetic latency: VMOV, VABS, VNEG, VCMP, VMRS
    float_arithmetic,  ///< VADD, VSUB, VMUL, VCVT
    float_accumulate,  ///< VMLA, VFMA and similar
    float_divide,      ///< VDIV, VSQRT
    float_transfer,    ///< VLDR, VSTR of one word; VMOV of two registers
    float_multiple,
  };
  Kind kind = Kind::plain;
  std::uint8_t bytes = 2;
  std::uint8_t words = 0;              ///< number of words that a multiple transfers
  bool writes_back = false;            ///< to the base register
  bool register_offset = false;        ///< the address is the sum of two registers
  bool loads_program_counter = false;  ///< a branch by a load
  bool reads_memory = false;           ///< also for several registers and for the FPU
  bool accesses_memory = false;
  std::uint8_t if_then_length = 0;      ///< number of instructions in the if-then block
  std::uint16_t address_registers = 0;  ///< R0 to R15, one bit each: base and index
  std::uint16_t written = 0;            ///< R0 to R15, one bit each
  std::uint32_t float_read = 0;         ///< S0 to S31, one bit each, without the addend of a multiply-accumulate
  std::uint32_t float_written = 0;
  std::uint8_t dividend = 0, divisor = 0;  ///< registers of a divide
  bool is_signed = false;                  ///< for divides
  bool has_literal = false;                ///< reads a word at `literal`, relative to the program counter
  /// Effect of the instruction on a register constant. ADR and MOVW set the whole value to `literal`; MOVT sets only
  /// the high half-word.
  enum class Constant : std::uint8_t { none, whole, high_half } constant = Constant::none;
  std::uint32_t literal = 0;
  // The address of a load is base + (index << shift) + offset.
  static constexpr std::uint8_t stack_pointer = 13;
  static constexpr std::uint8_t no_register = 0xFF;
  std::uint8_t base = no_register, index = no_register, shift = 0;
  std::int32_t offset = 0;

  bool uses_float() const { return kind >= Kind::float_plain; }
};

/// Returns true if `first` is the first half-word of a 32-bit instruction.
constexpr bool is_wide(std::uint16_t first) { return first >= 0xE800; }

/// Decodes the instruction at `address`. For narrow instructions, `second` is ignored. Invalid instructions have the
/// kind `plain`.
Instruction decode(std::uint16_t first, std::uint16_t second, std::uint32_t address);

}  // namespace inkwell::virtual_board
