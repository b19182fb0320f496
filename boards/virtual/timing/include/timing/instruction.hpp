// What the time of a Thumb-2 instruction depends on (ARMv7-M Architecture Reference Manual, A5).
#pragma once

#include <cstdint>

namespace inkwell::virtual_board {

struct Instruction {
  enum class Kind : std::uint8_t {
    plain,     ///< one cycle in the integer pipeline
    hint,      ///< NOP and its kin, which may vanish into the stall of a load
    if_then,   ///< IT
    divide,    ///< SDIV, UDIV
    load,      ///< one register
    store,     ///< one register
    multiple,  ///< several registers, or a pair
    exclusive,
    branch_immediate,
    branch_register,
    table_branch,
    system_register,
    barrier,
    instruction_barrier,
    call,              ///< SVC, BKPT, UDF: an exception follows
    float_plain,       ///< without the latency of arithmetic: VMOV, VABS, VNEG, VCMP, VMRS
    float_arithmetic,  ///< VADD, VSUB, VMUL, VCVT
    float_accumulate,  ///< VMLA, VFMA and their kin
    float_divide,      ///< VDIV, VSQRT
    float_transfer,    ///< VLDR, VSTR of one word; VMOV of two registers
    float_multiple,
  };
  Kind kind = Kind::plain;
  std::uint8_t bytes = 2;
  std::uint8_t words = 0;              ///< that a multiple moves
  bool writes_back = false;            ///< the base
  bool register_offset = false;        ///< the address is the sum of two registers
  bool loads_program_counter = false;  ///< a branch by a load
  bool reads_memory = false;           ///< also of several registers or of the FPU
  bool touches_memory = false;
  std::uint8_t if_then_length = 0;      ///< instructions that an IT governs
  std::uint16_t address_registers = 0;  ///< R0 to R15, a bit each: base and index
  std::uint16_t written = 0;            ///< R0 to R15, a bit each
  std::uint32_t float_read = 0;         ///< S0 to S31, a bit each, the addend of a multiply-accumulate excepted
  std::uint32_t float_written = 0;
  std::uint8_t dividend = 0, divisor = 0;  ///< registers of a divide
  bool is_signed = false;                  ///< of a divide
  bool has_literal = false;                ///< reads a word at `literal`, relative to the program counter
  /// What a constant becomes: nothing that is known, `literal` itself (ADR, MOVW), its high half (MOVT).
  enum class Constant : std::uint8_t { none, whole, high_half } constant = Constant::none;
  std::uint32_t literal = 0;
  // Where a load reads: base + (index << shift) + offset.
  static constexpr std::uint8_t stack_pointer = 13;
  static constexpr std::uint8_t no_register = 0xFF;
  std::uint8_t base = no_register, index = no_register, shift = 0;
  std::int32_t offset = 0;

  bool uses_float() const { return kind >= Kind::float_plain; }
};

/// Whether an instruction that begins with this half word has a second one.
constexpr bool is_wide(std::uint16_t first) { return first >= 0xE800; }

/// The instruction at `address`; `second` counts for wide ones only. What is no instruction comes out as plain.
Instruction decode(std::uint16_t first, std::uint16_t second, std::uint32_t address);

}  // namespace inkwell::virtual_board
