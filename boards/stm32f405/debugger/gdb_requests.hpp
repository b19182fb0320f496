// Parses and validates GDB requests without access to the chip (GDB manual, appendix "Remote Protocol", "Packets").
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace inkwell::virtual_board::gdb {

/// Maximum number of memory bytes per packet.
inline constexpr std::uint32_t memory_maximum = 0x2000;

/// Register numbers of the GDB target description: r0 to r15, xPSR, d0 to d15, FPSCR.
inline constexpr unsigned xpsr_number = 16, first_double = 17, fpscr_number = 33, register_count = 34;
constexpr std::size_t size_of_register(unsigned number) {
  return number >= first_double && number < fpscr_number ? 8 : 4;
}
/// Byte offset of a register in `g` and `G` packets.
constexpr std::size_t offset_of_register(unsigned number) {
  std::size_t offset = 0;
  for (unsigned i = 0; i < number; ++i) offset += size_of_register(i);
  return offset;
}
inline constexpr std::size_t size_of_all_registers = offset_of_register(register_count);

struct Range {
  std::uint32_t address, bytes;
  bool operator==(const Range&) const = default;
};

/// Reply to a request that does not access the chip. An empty reply means that the packet is not supported.
struct Answered {
  std::string reply;
};
struct WhyStopped {};
struct ReadRegisters {};
struct WriteRegisters {
  std::vector<std::uint8_t> bytes;  ///< size_of_all_registers bytes
};
struct ReadRegister {
  unsigned number;  ///< below register_count
};
struct WriteRegister {
  unsigned number;                  ///< below register_count
  std::vector<std::uint8_t> bytes;  ///< size_of_register(number) bytes
};
struct ReadMemory {
  Range range;  ///< at most memory_maximum bytes
};
struct WriteMemory {
  std::uint32_t address;
  std::vector<std::uint8_t> bytes;  ///< at least one
};
struct ChangeBreakpoint {
  bool sets;  ///< true: adds; false: removes
  std::uint32_t address;
};
struct ChangeWatchPoint {
  bool sets;  ///< true: adds; false: removes
  char kind;  ///< of the packet: '2' write, '3' read, '4' both
  Range range;
};
struct Resume {
  bool steps;  ///< one instruction only
};
struct LetGo {
  bool wants_answer;  ///< true for detach; GDB does not wait after kill
};
struct StopAcknowledging {};
struct Monitor {
  std::string command;  ///< user input after `monitor`
};

using Request =
    std::variant<Answered, WhyStopped, ReadRegisters, WriteRegisters, ReadRegister, WriteRegister, ReadMemory,
                 WriteMemory, ChangeBreakpoint, ChangeWatchPoint, Resume, LetGo, StopAcknowledging, Monitor>;

/// Parses the payload of a packet. A malformed packet results in `Answered` with an error.
Request request_of(std::string_view packet);

}  // namespace inkwell::virtual_board::gdb
