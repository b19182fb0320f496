// One GDB at the chip's debug port: answers its packets (GDB manual, appendix "Remote Protocol").
#pragma once

#include <chip/chip.hpp>
#include <debugger/gdb_packets.hpp>
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
  std::string answer(std::string_view packet);
  std::string answer_query(std::string_view packet);
  std::string answer_monitor(std::string_view command);
  std::string resume(char action);
  std::string stop_reply(unsigned signal) const;
  std::string change_point(std::string_view packet);
  std::string read_memory(std::string_view packet);
  std::string write_memory(std::string_view packet, bool binary);
  std::vector<std::uint8_t> all_registers() const;
  bool set_all_registers(const std::vector<std::uint8_t>& bytes);

  Chip& chip_;
  GdbPackets packets_;
  bool attached_ = false, halted_ = false;
  bool acknowledges_ = true;
  std::vector<Watched> watched_;
};

}  // namespace inkwell::virtual_board
