#include "boards/stm32f405/debugger/cpu_fault_report.hpp"
#include <algorithm>

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t stack_bytes_searched = 4096;

/// Returns true if the instruction before `address` is BL, or BLX with a register (ARMv7-M, A7.7.18 and A7.7.19).
bool is_after_call(std::uint32_t address, const MemoryReader& word) {
  const auto half_word = [&](std::uint32_t at) { return word(at & ~3u) >> 8 * (at & 2) & 0xFFFFu; };
  if (address < 4) return false;
  const std::uint32_t last = half_word(address - 2), before = half_word(address - 4);
  return ((before & 0xF800) == 0xF000 && (last & 0xD000) == 0xD000) || (last & 0xFF87) == 0x4780;
}

std::string location(std::uint32_t address, const Symbols& symbols) {
  const std::string name = symbols.name(address);
  return name.empty() ? fmt::format("0x{:08X}", address) : fmt::format("0x{:08X} {}", address, name);
}

std::string running(std::uint32_t xpsr) {
  const unsigned exception = xpsr & 0x1FF;
  if (exception == 0) return "thread mode";
  if (exception < 16) return fmt::format("the handler of exception {}", exception);
  return fmt::format("the handler of interrupt {}", exception - 16);
}

}  // namespace

std::vector<std::uint32_t> guess_callers(const CoreRegisters& registers, const MemoryReader& word, std::size_t limit) {
  std::vector<std::uint32_t> callers;
  const auto consider = [&](std::uint32_t value) {
    const std::uint32_t address = value & ~1u;
    const bool is_new = callers.empty() || callers.back() != address;
    if ((value & 1) != 0 && callers.size() < limit && is_new && is_after_call(address, word))
      callers.push_back(address);
  };
  consider(registers.general[CoreRegisters::lr]);
  const std::uint32_t stack = registers.general[CoreRegisters::sp] & ~3u;
  for (std::uint32_t offset = 0; offset < stack_bytes_searched; offset += 4) consider(word(stack + offset));
  return callers;
}

std::vector<std::string> explain_cpu_fault(const Chip& chip, const Symbols& symbols, const std::filesystem::path& elf) {
  if (!chip.first_fault()) return {};
  const Fault& fault = *chip.first_fault();
  const auto& r = fault.registers.general;
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("first fault at {:.6f} s in {}: {}", seconds(fault.when), running(fault.registers.xpsr), fault.what));
  lines.push_back("  at " + location(r[CoreRegisters::pc], symbols));
  for (unsigned i = 0; i < 12; i += 4)
    lines.push_back(fmt::format("  R{:<2} {:08X}  R{:<2} {:08X}  R{:<2} {:08X}  R{:<2} {:08X}", i, r[i], i + 1,
                                r[i + 1], i + 2, r[i + 2], i + 3, r[i + 3]));
  lines.push_back(fmt::format("  R12 {:08X}  SP  {:08X}  LR  {:08X}  PC  {:08X}  xPSR {:08X}", r[12], r[13], r[14],
                              r[15], fault.registers.xpsr));
  const auto callers = guess_callers(
      fault.registers, [&chip](std::uint32_t address) { return chip.memory_word(address); }, 8);
  if (!callers.empty()) lines.push_back("  probable callers, from LR and the stack:");
  for (const std::uint32_t caller : callers) lines.push_back("    " + location(caller, symbols));
  std::string command = fmt::format("  source lines: arm-none-eabi-addr2line -pfiaCe {} 0x{:X}", elf.string(), r[15]);
  for (const std::uint32_t caller : callers) command += fmt::format(" 0x{:X}", caller - 2);
  lines.push_back(command);
  return lines;
}

}  // namespace inkwell::virtual_board
