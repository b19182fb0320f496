#include "boards/stm32f405/timing/instruction.hpp"
#include <bit>

namespace inkwell::virtual_board {
namespace {

using Kind = Instruction::Kind;
constexpr unsigned stack_pointer = Instruction::stack_pointer, link_register = 14, program_counter = 15;

constexpr std::uint32_t bits(std::uint32_t word, unsigned high, unsigned low) {
  return word >> low & ((1u << (high - low + 1)) - 1);
}
constexpr bool bit(std::uint32_t word, unsigned position) { return (word >> position & 1) != 0; }
constexpr std::uint16_t one(std::uint32_t number) { return static_cast<std::uint16_t>(1u << number); }
constexpr std::uint8_t count(std::uint32_t list) { return static_cast<std::uint8_t>(std::popcount(list)); }

void writes(Instruction& it, std::uint32_t number) {
  if (number == program_counter) it.kind = Kind::branch_register;
  it.written = static_cast<std::uint16_t>(it.written | one(number));
}

/// Decodes a load or store of one register.
void single(Instruction& it, bool load, std::uint32_t data, std::uint32_t base) {
  it.kind = load ? Kind::load : Kind::store;
  it.reads_memory = load;
  it.accesses_memory = true;
  it.address_registers = one(base);
  it.base = static_cast<std::uint8_t>(base);
  if (!load) return;
  it.written = one(data);
  it.loads_program_counter = data == program_counter;
}

void indexed(Instruction& it, std::uint32_t index, std::uint32_t shift) {
  it.register_offset = true;
  it.index = static_cast<std::uint8_t>(index);
  it.shift = static_cast<std::uint8_t>(shift);
  it.address_registers = static_cast<std::uint16_t>(it.address_registers | one(index));
}

void multiple(Instruction& it, bool load, std::uint32_t list, std::uint32_t base, bool writes_back) {
  it.kind = Kind::multiple;
  it.words = count(list);
  it.reads_memory = load;
  it.accesses_memory = true;
  it.address_registers = one(base);
  it.base = static_cast<std::uint8_t>(base);
  it.writes_back = writes_back;
  it.written = static_cast<std::uint16_t>((load ? list : 0) | (writes_back ? one(base) : 0));
  it.loads_program_counter = load && bit(list, program_counter);
}

void literal(Instruction& it, std::uint32_t address, bool up, std::uint32_t offset) {
  const std::uint32_t base = (address + 4) & ~3u;
  it.has_literal = true;
  it.literal = up ? base + offset : base - offset;
}

// ---- 16 bits (A5.2)

void decode_data_processing(Instruction& it, std::uint32_t half) {
  constexpr std::uint32_t test = 8, compare = 10, compare_negative = 11;
  const std::uint32_t operation = bits(half, 9, 6);
  if (operation != test && operation != compare && operation != compare_negative) writes(it, bits(half, 2, 0));
}

void decode_special(Instruction& it, std::uint32_t half) {
  const std::uint32_t operation = bits(half, 9, 8);
  const std::uint32_t destination = bits(half, 2, 0) | (half >> 4 & 8);
  if (operation == 3) {
    it.kind = Kind::branch_register;
    if (bit(half, 7)) it.written = one(link_register);
  } else if (operation != 1) {
    writes(it, destination);
  }
}

void decode_miscellaneous(Instruction& it, std::uint32_t half) {
  if ((half & 0xFF00u) == 0xB000u) return writes(it, stack_pointer);
  if ((half & 0xF500u) == 0xB100u) {
    it.kind = Kind::branch_immediate;  // CBZ, CBNZ
  } else if ((half & 0xFE00u) == 0xB400u) {
    multiple(it, false, (half & 0xFF) | (bit(half, 8) ? 1u << link_register : 0), stack_pointer, true);
  } else if ((half & 0xFE00u) == 0xBC00u) {
    multiple(it, true, (half & 0xFF) | (bit(half, 8) ? 1u << program_counter : 0), stack_pointer, true);
  } else if ((half & 0xFF00u) == 0xBF00u) {
    const std::uint32_t mask = half & 0xF;
    it.kind = mask != 0 ? Kind::if_then : Kind::hint;
    if (mask != 0) it.if_then_length = static_cast<std::uint8_t>(4 - std::countr_zero(mask));
  } else if ((half & 0xFF00u) == 0xBE00u) {
    it.kind = Kind::call;
  } else if ((half & 0xFFE8u) == 0xB660u) {
    it.kind = Kind::system_register;  // CPS
  } else {
    writes(it, bits(half, 2, 0));  // extensions, REV
  }
}

void decode_narrow(Instruction& it, std::uint32_t half, std::uint32_t address) {
  const std::uint32_t three = bits(half, 2, 0), base = bits(half, 5, 3), high = bits(half, 10, 8);
  switch (bits(half, 15, 11)) {
    case 0b00000:
    case 0b00001:
    case 0b00010:
    case 0b00011: return writes(it, three);
    case 0b00101: return;  // CMP
    case 0b00100:
    case 0b00110:
    case 0b00111: return writes(it, high);
    case 0b01000: return bit(half, 10) ? decode_special(it, half) : decode_data_processing(it, half);
    case 0b01001: single(it, true, high, program_counter); return literal(it, address, true, (half & 0xFF) * 4);
    case 0b01010:
    case 0b01011: single(it, bits(half, 11, 9) >= 3, three, base); return indexed(it, bits(half, 8, 6), 0);
    case 0b01100:
    case 0b01101:
    case 0b01110:
    case 0b01111:
    case 0b10000:
    case 0b10001: {
      single(it, bit(half, 11), three, base);
      const std::uint32_t sort = bits(half, 15, 12), bytes = sort == 6 ? 4 : sort == 7 ? 1 : 2;
      it.offset = static_cast<std::int32_t>(bits(half, 10, 6) * bytes);
      return;
    }
    case 0b10010:
    case 0b10011: return single(it, bit(half, 11), high, stack_pointer);
    case 0b10100:
      literal(it, address, true, (half & 0xFF) * 4);
      it.has_literal = false;
      it.constant = Instruction::Constant::whole;
      return writes(it, high);
    case 0b10101: return writes(it, high);
    case 0b10110:
    case 0b10111: return decode_miscellaneous(it, half);
    case 0b11000: return multiple(it, false, half & 0xFF, high, true);
    case 0b11001: return multiple(it, true, half & 0xFF, high, !bit(half, high));
    case 0b11010:
    case 0b11011:
      it.kind = bits(half, 11, 9) == 7 ? Kind::call : Kind::branch_immediate;  // conditions 14 and 15: UDF, SVC
      return;
    default: it.kind = Kind::branch_immediate;
  }
}

// ---- 32 bits (A5.3)

void decode_dual_or_exclusive(Instruction& it, std::uint32_t first, std::uint32_t second, std::uint32_t address) {
  const std::uint32_t base = first & 0xF;
  const bool load = bit(first, 4);
  if (!bit(first, 8) && !bit(first, 5)) {  // P and W clear
    const bool table = bit(first, 7) && load && bits(second, 7, 5) == 0;
    it.address_registers = one(base);
    it.accesses_memory = it.reads_memory = true;
    if (table) {
      it.kind = Kind::table_branch;
      it.address_registers = static_cast<std::uint16_t>(it.address_registers | one(second & 0xF));
      return;
    }
    it.kind = Kind::exclusive;
    it.written = one(load ? bits(second, 15, 12) : (bit(first, 7) ? second & 0xF : bits(second, 11, 8)));
    return;
  }
  const std::uint32_t pair = (1u << bits(second, 15, 12)) | (1u << bits(second, 11, 8));
  multiple(it, load, pair & 0x7FFF, base, bit(first, 5));
  it.words = 2;
  if (bit(first, 8)) it.offset = static_cast<std::int32_t>((second & 0xFF) * 4) * (bit(first, 7) ? 1 : -1);
  if (load && base == program_counter) literal(it, address, bit(first, 7), (second & 0xFF) * 4);
}

void decode_float_transfer(Instruction& it, std::uint32_t first, std::uint32_t second, std::uint32_t address) {
  const bool load = bit(first, 4), is_double = bit(second, 8);
  const std::uint32_t start =
      is_double ? 2 * (bits(second, 15, 12) & 15) : 2 * bits(second, 15, 12) + (bit(first, 6) ? 1u : 0u);
  const auto range = [start](std::uint32_t words) {
    const std::uint64_t all = ((std::uint64_t{1} << words) - 1) << start;
    return static_cast<std::uint32_t>(all);
  };
  if (bits(first, 8, 5) == 2) {  // VMOV between two core registers and two singles or a double
    it.kind = Kind::float_transfer;
    const std::uint32_t low = 2 * (second & 0xF) + (bit(second, 5) && !is_double ? 1u : 0u);
    const auto pair = static_cast<std::uint32_t>(std::uint64_t{3} << low);
    (load ? it.float_read : it.float_written) = pair;
    if (load) it.written = static_cast<std::uint16_t>(one(bits(second, 15, 12)) | one(first & 0xF));
    return;
  }
  const bool one_register = bit(first, 8) && !bit(first, 5);
  const std::uint32_t words = one_register ? (is_double ? 2 : 1) : second & 0xFE ? second & 0xFF : second & 1;
  it.kind = words == 1 && one_register ? Kind::float_transfer : Kind::float_multiple;
  it.words = static_cast<std::uint8_t>(words);
  it.accesses_memory = true;
  it.reads_memory = load;
  it.address_registers = one(first & 0xF);
  it.base = static_cast<std::uint8_t>(first & 0xF);
  if (one_register) it.offset = static_cast<std::int32_t>((second & 0xFF) * 4) * (bit(first, 7) ? 1 : -1);
  it.writes_back = bit(first, 5);
  if (it.writes_back) it.written = one(first & 0xF);
  if (load && it.base == program_counter) literal(it, address, bit(first, 7), (second & 0xFF) * 4);
  (load ? it.float_written : it.float_read) = range(words > 32 ? 32 : words);
}

void decode_float(Instruction& it, std::uint32_t first, std::uint32_t second) {
  const std::uint32_t destination = 2 * bits(second, 15, 12) + (bit(first, 6) ? 1u : 0u);
  const std::uint32_t operand = 2 * (first & 0xF) + (bit(second, 7) ? 1u : 0u);
  const std::uint32_t other = 2 * (second & 0xF) + (bit(second, 5) ? 1u : 0u);
  if (bit(second, 4)) {  // one register between core and FPU
    it.kind = Kind::float_plain;
    if (bits(first, 7, 5) == 7) {  // VMRS, VMSR
      if (bit(first, 4) && bits(second, 15, 12) != program_counter) it.written = one(bits(second, 15, 12));
    } else if (bit(first, 4)) {
      it.written = one(bits(second, 15, 12));
      it.float_read = 1u << operand;
    } else {
      it.float_written = 1u << operand;
    }
    return;
  }
  const std::uint32_t operation = bits(first, 7, 4) & 0b1011;
  it.float_written = 1u << destination;
  it.float_read = (1u << operand) | (1u << other);
  switch (operation) {
    case 0b0000:
    case 0b0001:
    case 0b1001:
    case 0b1010: it.kind = Kind::float_accumulate; return;
    case 0b0010:
    case 0b0011: it.kind = Kind::float_arithmetic; return;
    case 0b1000: it.kind = Kind::float_divide; return;
    default: break;
  }
  it.float_read = 1u << other;
  it.kind = Kind::float_plain;
  if (!bit(second, 6)) {  // VMOV of an immediate
    it.float_read = 0;
    return;
  }
  const std::uint32_t sort = first & 0xF;
  if (sort == 1 && bit(second, 7)) it.kind = Kind::float_divide;  // VSQRT
  if (sort == 4 || sort == 5) {                                   // VCMP
    it.float_read = (1u << destination) | (sort == 4 ? 1u << other : 0u);
    it.float_written = 0;
  }
  if (sort == 2 || sort == 3 || sort >= 7) it.kind = Kind::float_arithmetic;  // VCVT
}

void decode_branch_or_system(Instruction& it, std::uint32_t first, std::uint32_t second) {
  it.kind = Kind::branch_immediate;
  if ((second & 0xD000) == 0xD000) it.written = one(link_register);
  if ((second & 0xD000) != 0x8000 || (first & 0x0380) != 0x0380) return;
  // Encodings with condition 14 or 15 are not branches.
  it.kind = Kind::system_register;
  if ((first & 0xFFF0) == 0xF3A0) it.kind = Kind::hint;
  if ((first & 0xFFF0) == 0xF3B0) it.kind = bits(second, 7, 4) == 6 ? Kind::instruction_barrier : Kind::barrier;
  if ((first & 0xFFF0) == 0xF3E0) it.written = one(bits(second, 11, 8));
  if ((first & 0xFFF0) == 0xF7F0) it.kind = Kind::call;  // UDF
}

void decode_single_wide(Instruction& it, std::uint32_t first, std::uint32_t second, std::uint32_t address) {
  const std::uint32_t base = first & 0xF, data = bits(second, 15, 12);
  const bool load = bit(first, 4);
  const bool word = bits(first, 6, 5) == 2;
  if (load && data == program_counter && !word) {
    it.kind = Kind::hint;  // PLD
    return;
  }
  single(it, load, data, base);
  if (load && base == program_counter) return literal(it, address, bit(first, 7), second & 0xFFF);
  if (bit(first, 7)) {
    it.offset = static_cast<std::int32_t>(second & 0xFFF);
    return;
  }
  if (!bit(second, 11)) return indexed(it, second & 0xF, bits(second, 5, 4));
  if (bit(second, 10)) it.offset = static_cast<std::int32_t>(second & 0xFF) * (bit(second, 9) ? 1 : -1);
  it.writes_back = bit(second, 8);
  if (it.writes_back) it.written = static_cast<std::uint16_t>(it.written | one(base));
}

void decode_multiply(Instruction& it, std::uint32_t first, std::uint32_t second) {
  const bool is_long = bit(first, 7);
  it.written = one(bits(second, 11, 8));
  if (!is_long) return;
  const std::uint32_t operation = bits(first, 6, 4);
  if ((operation == 1 || operation == 3) && bits(second, 7, 4) == 0xF) {
    it.kind = Kind::divide;
    it.dividend = static_cast<std::uint8_t>(first & 0xF);
    it.divisor = static_cast<std::uint8_t>(second & 0xF);
    it.is_signed = operation == 1;
    return;
  }
  it.written = static_cast<std::uint16_t>(it.written | one(bits(second, 15, 12)));
}

/// Decodes ADR, MOVW and MOVT, because code computes table addresses with these instructions.
void decode_constant(Instruction& it, std::uint32_t first, std::uint32_t second, std::uint32_t address) {
  const std::uint32_t sort = first & 0xFBF0, low = bits(second, 14, 12) << 8 | (second & 0xFF);
  const std::uint32_t twelve = (first & 0x0400) << 1 | low;
  if (sort == 0xF240 || sort == 0xF2C0) {
    it.constant = sort == 0xF240 ? Instruction::Constant::whole : Instruction::Constant::high_half;
    it.literal = (first & 0xF) << 12 | twelve;
  } else if ((first & 0xFBFF) == 0xF20F || (first & 0xFBFF) == 0xF2AF) {
    literal(it, address, (first & 0x00A0) == 0, twelve);
    it.has_literal = false;
    it.constant = Instruction::Constant::whole;
  }
}

void decode_wide(Instruction& it, std::uint32_t first, std::uint32_t second, std::uint32_t address) {
  it.bytes = 4;
  const std::uint32_t group = bits(first, 12, 11);
  if (group == 1) {
    if (!bit(first, 10) && !bit(first, 9)) {
      if (bit(first, 6)) return decode_dual_or_exclusive(it, first, second, address);
      return multiple(it, bit(first, 4), second, first & 0xF, bit(first, 5));
    }
    if (!bit(first, 10)) {  // data processing with a shifted register; comparisons have no destination
      if (bits(second, 11, 8) != program_counter) it.written = one(bits(second, 11, 8));
      return;
    }
    if (bits(second, 11, 9) != 5) return;  // a coprocessor that the chip does not have
    return bits(first, 9, 8) == 2 ? decode_float(it, first, second) : decode_float_transfer(it, first, second, address);
  }
  if (group == 2) {
    if (bit(second, 15)) return decode_branch_or_system(it, first, second);
    decode_constant(it, first, second, address);
    if (bits(second, 11, 8) != program_counter) it.written = one(bits(second, 11, 8));
    return;
  }
  if (bit(first, 10)) {
    if (bits(second, 11, 9) != 5) return;
    return bits(first, 9, 8) == 2 ? decode_float(it, first, second) : decode_float_transfer(it, first, second, address);
  }
  if (!bit(first, 9)) return decode_single_wide(it, first, second, address);
  if (bit(first, 8)) return decode_multiply(it, first, second);
  it.written = one(bits(second, 11, 8));
}

}  // namespace

Instruction decode(std::uint16_t first, std::uint16_t second, std::uint32_t address) {
  Instruction it;
  if (is_wide(first))
    decode_wide(it, first, second, address);
  else
    decode_narrow(it, first, address);
  return it;
}

}  // namespace inkwell::virtual_board
