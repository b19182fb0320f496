// One GDB at the chip's debug port: answers its packets (GDB manual, appendix "Remote Protocol").
#pragma once

#include <chip/chip.hpp>
#include <debugger/gdb_packets.hpp>
#include <debugger/gdb_requests.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace inkwell::virtual_board {

class GdbSession {
 public:
  /// `chip` is in exact mode and outlives the session.
  explicit GdbSession(Chip& chip) : chip_(chip) {}

  /// GDB has connected: the processor stands still from now on.
  void attach();
  /// GDB has gone, or let go: the processor runs on.
  void detach();
  bool attached() const { return attached_; }
  /// Board time stands still until GDB goes on.
  bool halted() const { return attached_ && halted_; }

  /// Takes bytes of GDB and returns those of the answer.
  std::string receive(std::string_view bytes);
  /// run_until() came back. Returns what GDB is told.
  std::string report(Stop stop);

 private:
  struct Watched {
    WatchPoint place;
    char kind;  ///< of the packet: 2 write, 3 read, 4 both
  };
  // Each returns what GDB is answered; nothing is said while the processor runs.
  static std::string carry_out(const gdb::Answered& asked);
  std::string carry_out(gdb::WhyStopped asked);
  std::string carry_out(gdb::ReadRegisters asked);
  std::string carry_out(const gdb::WriteRegisters& asked);
  std::string carry_out(gdb::ReadRegister asked);
  std::string carry_out(const gdb::WriteRegister& asked);
  std::string carry_out(gdb::ReadMemory asked);
  std::string carry_out(const gdb::WriteMemory& asked);
  std::string carry_out(gdb::ChangeBreakpoint asked);
  std::string carry_out(gdb::ChangeWatchPoint asked);
  std::string carry_out(gdb::Resume asked);
  std::string carry_out(gdb::LetGo asked);
  std::string carry_out(gdb::StopAcknowledging asked);
  std::string carry_out(const gdb::Monitor& asked);
  std::string stop_reply(unsigned signal) const;
  std::vector<std::uint8_t> all_registers() const;
  /// `bytes` are gdb::size_of_all_registers.
  void set_all_registers(const std::vector<std::uint8_t>& bytes);

  Chip& chip_;
  GdbPackets packets_;
  bool attached_ = false, halted_ = false;
  bool acknowledges_ = true;
  std::vector<Watched> watched_;
};

}  // namespace inkwell::virtual_board
