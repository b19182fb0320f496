// One GDB connection to the debug port of the chip (GDB manual, appendix "Remote Protocol").
#pragma once

#include <string>
#include <string_view>
#include <vector>
#include "boards/stm32f405/debugger/gdb_packets.hpp"
#include "boards/stm32f405/debugger/gdb_requests.hpp"
#include "boards/stm32f405/wiring/chip.hpp"

namespace inkwell::virtual_board {

class GdbSession {
 public:
  /// `chip` must be in exact mode and must outlive the session.
  explicit GdbSession(Chip& chip) : chip_(chip) {}

  /// Call this function when GDB has connected. The processor stops.
  void attach();
  /// Call this function when GDB has disconnected or detached. The processor continues.
  void detach();
  bool attached() const { return attached_; }
  /// Returns true while GDB has stopped board time.
  bool halted() const { return attached_ && halted_; }

  /// Handles received bytes and returns the bytes of the reply.
  std::string receive(std::string_view bytes);
  /// Call this function when run_until() has returned. Returns the stop reply for GDB.
  std::string report(Stop stop);

 private:
  struct Watched {
    WatchPoint point;
    char kind;  ///< of the packet: '2' write, '3' read, '4' both
  };
  // Each carry_out() returns the reply to GDB. The reply is empty if the request makes the processor run.
  static std::string carry_out(const gdb::Answered& parsed);
  std::string carry_out(gdb::WhyStopped parsed);
  std::string carry_out(gdb::ReadRegisters parsed);
  std::string carry_out(const gdb::WriteRegisters& parsed);
  std::string carry_out(gdb::ReadRegister parsed);
  std::string carry_out(const gdb::WriteRegister& parsed);
  std::string carry_out(gdb::ReadMemory parsed);
  std::string carry_out(const gdb::WriteMemory& parsed);
  std::string carry_out(gdb::ChangeBreakpoint parsed);
  std::string carry_out(gdb::ChangeWatchPoint parsed);
  std::string carry_out(gdb::Resume parsed);
  std::string carry_out(gdb::LetGo parsed);
  std::string carry_out(gdb::StopAcknowledging parsed);
  std::string carry_out(const gdb::Monitor& parsed);
  std::string stop_reply(unsigned signal) const;
  std::vector<std::uint8_t> all_registers() const;
  /// `bytes` must have the size gdb::size_of_all_registers.
  void set_all_registers(const std::vector<std::uint8_t>& bytes);

  Chip& chip_;
  GdbPackets packets_;
  bool attached_ = false, halted_ = false;
  bool acknowledges_ = true;
  std::vector<Watched> watched_;
};

}  // namespace inkwell::virtual_board
