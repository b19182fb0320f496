// What GDB asks for, as far as it can be understood and checked without a chip (GDB manual, appendix "Remote Protocol",
// "Packets").
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace inkwell::virtual_board::gdb {

/// Bytes of memory that go into one packet, at most.
inline constexpr std::uint32_t memory_maximum = 0x2000;

/// What GDB calls the registers, by the description of the target that it reads: r0 to r15, xPSR, d0 to d15, FPSCR.
inline constexpr unsigned xpsr_number = 16, first_double = 17, fpscr_number = 33, register_count = 34;
constexpr std::size_t size_of_register(unsigned number) {
  return number >= first_double && number < fpscr_number ? 8 : 4;
}
/// Where a register begins among the bytes of all of them, in the packets g and G.
constexpr std::size_t place_of_register(unsigned number) {
  std::size_t place = 0;
  for (unsigned i = 0; i < number; ++i) place += size_of_register(i);
  return place;
}
inline constexpr std::size_t size_of_all_registers = place_of_register(register_count);

struct Range {
  std::uint32_t address, bytes;
  bool operator==(const Range&) const = default;
};

/// Needs no chip: what GDB is answered. Empty for a packet that is not known, by which GDB learns just that.
struct Answered {
  std::string reply;
};
struct WhyStopped {};
struct ReadRegisters {};
struct WriteRegisters {
  std::vector<std::uint8_t> bytes;  ///< size_of_all_registers of them
};
struct ReadRegister {
  unsigned number;  ///< below register_count
};
struct WriteRegister {
  unsigned number;                  ///< below register_count
  std::vector<std::uint8_t> bytes;  ///< size_of_register(number) of them
};
struct ReadMemory {
  Range range;  ///< memory_maximum bytes at most
};
struct WriteMemory {
  std::uint32_t address;
  std::vector<std::uint8_t> bytes;  ///< one at least
};
struct ChangeBreakpoint {
  bool sets;  ///< or removes
  std::uint32_t address;
};
struct ChangeWatchPoint {
  bool sets;  ///< or removes
  char kind;  ///< of the packet: '2' write, '3' read, '4' both
  Range range;
};
struct Resume {
  bool steps;  ///< one instruction only
};
struct LetGo {
  bool wants_answer;  ///< GDB detaches; it does not wait when it kills
};
struct StopAcknowledging {};
struct Monitor {
  std::string command;  ///< as the user typed it behind `monitor`
};

using Request =
    std::variant<Answered, WhyStopped, ReadRegisters, WriteRegisters, ReadRegister, WriteRegister, ReadMemory,
                 WriteMemory, ChangeBreakpoint, ChangeWatchPoint, Resume, LetGo, StopAcknowledging, Monitor>;

/// What a packet without its frame asks for. Any bytes are borne; what is malformed is Answered with an error.
Request request_of(std::string_view packet);

}  // namespace inkwell::virtual_board::gdb
