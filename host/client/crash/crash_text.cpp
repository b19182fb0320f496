#include "host/client/crash/crash_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::crash {
namespace {

/// A bit of CFSR and its meaning (ARMv7-M, B3.2.15).
struct CpuFaultBit {
  unsigned bit;
  const char* meaning;
};

constexpr CpuFaultBit cpu_fault_bits[] = {
    {3, "memory protection refused a stack access on exception return"},
    {4,
     "memory protection refused a stack access on exception entry: the stack has overflowed, or the stack pointer is "
     "wrong"},
    {5, "memory protection refused a stack access while floating-point registers were saved"},
    {11, "the stack was in unmapped memory on exception return"},
    {12,
     "the stack was in unmapped memory on exception entry: the stack has overflowed, or the stack pointer is wrong"},
    {13, "the stack was in unmapped memory while floating-point registers were saved"},
    {0, "it fetched an instruction from memory that must not be executed"},
    {1, "it accessed memory in a way that memory protection forbids"},
    {8, "it fetched an instruction from unmapped memory"},
    {9, "it accessed an unmapped address"},
    {10, "a store some instructions earlier went to an unmapped address"},
    {16, "it met an undefined instruction"},
    {17, "it left its only instruction set"},
    {18, "it returned from an exception with an invalid return value"},
    {19, "it met an instruction for a missing coprocessor"},
    {24, "an access was not aligned"},
    {25, "it divided by zero"},
};
constexpr unsigned protection_address_holds = 7, bus_address_holds = 15;

bool has(std::uint32_t status, unsigned bit) { return (status >> bit & 1) != 0; }

}  // namespace

std::string cause(const protocol::CrashFacts& crash) {
  const std::uint32_t status = crash.configurable_fault_status;
  if (crash.exception == protocol::crystal_exception) return "The crystal stopped.";
  if (crash.exception == protocol::hang_exception) return "The main loop hung, and the watchdog expired.";
  if (crash.exception >= 16)
    return fmt::format("Interrupt {} occurred, although it is not used.", crash.exception - 16);
  if (has(crash.hard_fault_status, 1)) return "A handler's address could not be read from the vector table.";
  const auto* found = std::find_if(std::begin(cpu_fault_bits), std::end(cpu_fault_bits),
                                   [&](const CpuFaultBit& cpu_fault) { return has(status, cpu_fault.bit); });
  if (found == std::end(cpu_fault_bits)) return fmt::format("The processor raised exception {}.", crash.exception);
  std::string sentence = fmt::format("The processor could not continue: {}", found->meaning);
  if (has(status, protection_address_holds) || has(status, bus_address_holds))
    sentence += fmt::format(", 0x{:08x}", crash.fault_address);
  return sentence + ".";
}

std::vector<std::uint32_t> chain(const protocol::CrashFacts& crash) {
  if (crash.stack_pointer == 0) return {};
  std::vector<std::uint32_t> addresses{crash.program_counter};
  for (const std::uint32_t caller : crash.callers)
    if (caller != 0 && caller != addresses.back()) addresses.push_back(caller);
  return addresses;
}

void require_image_of(const protocol::CrashFacts& crash, const FirmwareImage& image) {
  const auto check = image.check();
  if (!check)
    throw device::Error(
        "This ELF file has no checksum, so it is not an image that was flashed. Give the ELF file that the build has "
        "written.");
  if (*check != crash.image_check)
    throw device::Error(
        fmt::format("This is not the firmware that crashed: its checksum is 0x{:08x}, but the crashed firmware has "
                    "0x{:08x}. Give the ELF file of that build.",
                    *check, crash.image_check));
}

std::string text(const protocol::CrashFacts& crash, const FirmwareImage* image) {
  std::string lines = cause(crash) + "\n";
  const auto addresses = chain(crash);
  if (addresses.empty()) lines += "  at an unknown address, because the stack could not be read\n";
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    // A return address points after its call instruction.
    const std::string name = image == nullptr ? "" : image->source_location(i == 0 ? addresses[i] : addresses[i] - 2);
    lines += fmt::format("  {} 0x{:08x}{}{}\n",
                         i == 0   ? "at  "
                         : i == 1 ? "from"
                                  : "    ",
                         addresses[i], name.empty() ? "" : " ", name);
  }
  for (std::size_t i = 0; !addresses.empty() && i < std::size(crash.registers); ++i)
    lines += fmt::format("  r{:<2} {:08x}{}", i, crash.registers[i],
                         i % 5 == 4 || i + 1 == std::size(crash.registers) ? "\n" : "");
  lines +=
      fmt::format("  sp {:08x}  lr {:08x}  xPSR {:08x}  CFSR {:08x}  HFSR {:08x}", crash.stack_pointer,
                  crash.link_register, crash.program_status, crash.configurable_fault_status, crash.hard_fault_status);
  if (image == nullptr && !addresses.empty())
    lines += "\nRun `inkwell fault --elf FILE` with the ELF file of the flashed firmware to see the function names.";
  return lines;
}

}  // namespace inkwell::crash
