#include <crash/crash_text.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <device/error.hpp>

namespace inkwell::crash {
namespace {

/// A bit of CFSR and its meaning (ARMv7-M, B3.2.15). A stack error also explains other bits that are set at the same
/// time.
struct FaultBit {
  unsigned bit;
  const char* meaning;
};

constexpr FaultBit fault_bits[] = {
    {3, "memory protection refused the stack on the way out of an interrupt"},
    {4, "memory protection refused the stack on the way into an interrupt: it has overflowed or been lost"},
    {5, "memory protection refused the stack for the floats of an interrupted program"},
    {11, "the stack lay where nothing is on the way out of an interrupt"},
    {12, "the stack lay where nothing is on the way into an interrupt: it has overflowed or been lost"},
    {13, "the stack lay where nothing is for the floats of an interrupted program"},
    {0, "it went to run what is no code"},
    {1, "it used memory in a way that is not allowed there"},
    {8, "it went to run from where nothing is"},
    {9, "nothing answered at the address"},
    {10, "a store came to where nothing is, some instructions before"},
    {16, "it met what is no instruction"},
    {17, "it left the instruction set that it has"},
    {18, "it returned from an exception in a way that does not exist"},
    {19, "it met an instruction of a coprocessor that is not there"},
    {24, "an access was not aligned"},
    {25, "it divided by zero"},
};
constexpr unsigned protection_address_holds = 7, bus_address_holds = 15;

bool has(std::uint32_t status, unsigned bit) { return (status >> bit & 1) != 0; }

}  // namespace

std::string cause(const protocol::CrashFacts& crash) {
  const std::uint32_t status = crash.configurable_fault_status;
  if (crash.exception == protocol::crystal_exception) return "The crystal stopped.";
  if (crash.exception == protocol::hang_exception) return "The main loop did not come round, and the watchdog bit.";
  if (crash.exception >= 16) return fmt::format("Interrupt {} came, which nobody has asked for.", crash.exception - 16);
  if (has(crash.hard_fault_status, 1)) return "A handler's address could not be read from the vector table.";
  const auto* found = std::find_if(std::begin(fault_bits), std::end(fault_bits),
                                   [&](const FaultBit& fault) { return has(status, fault.bit); });
  if (found == std::end(fault_bits)) return fmt::format("The processor met exception {}.", crash.exception);
  std::string sentence = fmt::format("The processor could not go on: {}", found->meaning);
  if (has(status, protection_address_holds) || has(status, bus_address_holds))
    sentence += fmt::format(", 0x{:08x}", crash.fault_address);
  return sentence + ".";
}

std::vector<std::uint32_t> chain(const protocol::CrashFacts& crash) {
  if (crash.stack_pointer == 0) return {};
  std::vector<std::uint32_t> places{crash.program_counter};
  for (const std::uint32_t caller : crash.callers)
    if (caller != 0 && caller != places.back()) places.push_back(caller);
  return places;
}

void require_image_of(const protocol::CrashFacts& crash, const FirmwareImage& image) {
  const auto check = image.check();
  if (!check)
    throw device::Error(
        "This ELF has no checksum, so it is no image of this firmware as it is flashed. Give the one "
        "that the build has left.");
  if (*check != crash.image_check)
    throw device::Error(
        fmt::format("This is not the firmware that crashed: its checksum is 0x{:08x}, and 0x{:08x} ran. "
                    "Give the ELF of that build.",
                    *check, crash.image_check));
}

std::string text(const protocol::CrashFacts& crash, const FirmwareImage* image) {
  std::string lines = cause(crash) + "\n";
  const auto places = chain(crash);
  if (places.empty()) lines += "  at an unknown place, for its stack could not be read\n";
  for (std::size_t i = 0; i < places.size(); ++i) {
    // The call instruction is directly before its return address.
    const std::string name = image == nullptr ? "" : image->place(i == 0 ? places[i] : places[i] - 2);
    lines += fmt::format("  {} 0x{:08x}{}{}\n",
                         i == 0   ? "at  "
                         : i == 1 ? "from"
                                  : "    ",
                         places[i], name.empty() ? "" : " ", name);
  }
  for (std::size_t i = 0; !places.empty() && i < std::size(crash.registers); ++i)
    lines += fmt::format("  r{:<2} {:08x}{}", i, crash.registers[i],
                         i % 5 == 4 || i + 1 == std::size(crash.registers) ? "\n" : "");
  lines +=
      fmt::format("  sp {:08x}  lr {:08x}  xPSR {:08x}  CFSR {:08x}  HFSR {:08x}", crash.stack_pointer,
                  crash.link_register, crash.program_status, crash.configurable_fault_status, crash.hard_fault_status);
  if (image == nullptr && !places.empty())
    lines += "\n`inkwell fault --elf FILE` names the functions, with the ELF of the firmware that was flashed.";
  return lines;
}

}  // namespace inkwell::crash
