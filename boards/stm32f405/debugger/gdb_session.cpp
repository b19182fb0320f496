#include "boards/stm32f405/debugger/gdb_session.hpp"
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

constexpr unsigned signal_interrupt = 2, signal_trap = 5, signal_fault = 11;
constexpr const char *ok = "OK", *no_memory = "E0e";

}  // namespace

void GdbSession::attach() {
  packets_ = {};
  attached_ = halted_ = acknowledges_ = true;
  chip_.debug_port().attach();
}

void GdbSession::detach() {
  attached_ = halted_ = false;
  watched_.clear();
  chip_.debug_port().detach();
}

std::string GdbSession::receive(std::string_view bytes) {
  packets_.feed(bytes);
  std::string out;
  while (const auto received = packets_.take()) {
    if (received->kind == GdbPackets::Received::Kind::interrupt) {
      if (halted_) continue;
      halted_ = true;
      out += gdb_packet(stop_reply(signal_interrupt));
      continue;
    }
    const bool is_whole = received->kind == GdbPackets::Received::Kind::packet;
    if (acknowledges_) out += is_whole ? '+' : '-';
    if (!is_whole) continue;
    const gdb::Request request = gdb::request_of(received->payload);
    const std::string reply = std::visit([this](const auto& parsed) { return carry_out(parsed); }, request);
    if (attached_ && halted_) out += gdb_packet(reply);
    if (const auto* const let_go = std::get_if<gdb::LetGo>(&request); let_go != nullptr && let_go->wants_answer)
      out += gdb_packet(ok);
  }
  return out;
}

std::string GdbSession::report(Stop stop) {
  if (!attached_ || halted_) return {};
  switch (stop) {
    case Stop::debugger: halted_ = true; return gdb_packet(stop_reply(signal_trap));
    case Stop::locked_up:
      halted_ = true;
      return gdb_packet("O" + hexadecimal(chip_.lockup_reason() + "\n")) + gdb_packet(stop_reply(signal_fault));
    case Stop::firmware_exit: return gdb_packet(fmt::format("W{:02x}", chip_.exit_code() & 0xFF));
    case Stop::time_reached:
    case Stop::requested: break;
  }
  return {};
}

std::string GdbSession::stop_reply(unsigned signal) const {
  std::string reply = fmt::format("T{:02x}thread:1;", signal);
  const DebugStop stop = chip_.debug_port().last_stop();
  if (signal != signal_trap || stop.reason != DebugStop::Reason::watch_point) return reply;
  for (const auto& [point, kind] : watched_)
    if (stop.address - point.address < point.bytes) {
      const char* name = kind == '2' ? "watch" : kind == '3' ? "rwatch" : "awatch";
      return reply + fmt::format("{}:{:x};", name, point.address);
    }
  return reply;
}

std::string GdbSession::carry_out(const gdb::Answered& parsed) { return parsed.reply; }

std::string GdbSession::carry_out(gdb::WhyStopped) { return stop_reply(signal_trap); }

std::string GdbSession::carry_out(gdb::ReadRegisters) { return hexadecimal(all_registers()); }

std::string GdbSession::carry_out(const gdb::WriteRegisters& parsed) {
  set_all_registers(parsed.bytes);
  return ok;
}

std::string GdbSession::carry_out(gdb::ReadRegister parsed) {
  const auto all = all_registers();
  return hexadecimal(
      std::span(all).subspan(gdb::offset_of_register(parsed.number), gdb::size_of_register(parsed.number)));
}

std::string GdbSession::carry_out(const gdb::WriteRegister& parsed) {
  auto all = all_registers();
  std::ranges::copy(parsed.bytes, all.begin() + static_cast<std::ptrdiff_t>(gdb::offset_of_register(parsed.number)));
  set_all_registers(all);
  return ok;
}

std::string GdbSession::carry_out(gdb::ReadMemory parsed) {
  std::vector<std::uint8_t> bytes(parsed.range.bytes);
  return chip_.debug_port().read(parsed.range.address, bytes) ? hexadecimal(bytes) : no_memory;
}

std::string GdbSession::carry_out(const gdb::WriteMemory& parsed) {
  return chip_.debug_port().write(parsed.address, parsed.bytes) ? ok : no_memory;
}

std::string GdbSession::carry_out(gdb::ChangeBreakpoint parsed) {
  auto& port = chip_.debug_port();
  parsed.sets ? port.add_breakpoint(parsed.address) : port.remove_breakpoint(parsed.address);
  return ok;
}

std::string GdbSession::carry_out(gdb::ChangeWatchPoint parsed) {
  auto& port = chip_.debug_port();
  const WatchPoint point{parsed.range.address, parsed.range.bytes, parsed.kind != '2', parsed.kind != '3'};
  const auto found = std::ranges::find_if(
      watched_, [&](const Watched& watched) { return watched.point == point && watched.kind == parsed.kind; });
  if (parsed.sets && found == watched_.end()) {
    port.add_watch_point(point);
    watched_.push_back({point, parsed.kind});
  } else if (!parsed.sets && found != watched_.end()) {
    port.remove_watch_point(point);
    watched_.erase(found);
  }
  return ok;
}

std::string GdbSession::carry_out(gdb::Resume parsed) {
  parsed.steps ? chip_.debug_port().step() : chip_.debug_port().resume();
  halted_ = false;
  return {};
}

std::string GdbSession::carry_out(gdb::LetGo) {
  detach();
  return {};
}

std::string GdbSession::carry_out(gdb::StopAcknowledging) {
  acknowledges_ = false;
  return ok;
}

std::string GdbSession::carry_out(const gdb::Monitor& parsed) {
  if (parsed.command == "reset" || parsed.command == "reset halt") {
    chip_.reset();
    return ok;
  }
  if (parsed.command == "time") return hexadecimal(fmt::format("{:.9f} s of board time\n", seconds(chip_.now())));
  return hexadecimal(
      std::string_view("monitor reset: reset the chip and stop at its first instruction\n"
                       "monitor time: print board time\n"));
}

std::vector<std::uint8_t> GdbSession::all_registers() const {
  const auto core = chip_.debug_port().core_registers();
  const auto floats = chip_.debug_port().float_registers();
  std::vector<std::uint8_t> bytes(gdb::size_of_all_registers);
  std::memcpy(bytes.data(), core.general.data(), sizeof core.general);
  std::memcpy(bytes.data() + gdb::offset_of_register(gdb::xpsr_number), &core.xpsr, sizeof core.xpsr);
  std::memcpy(bytes.data() + gdb::offset_of_register(gdb::first_double), floats.doubles.data(), sizeof floats.doubles);
  std::memcpy(bytes.data() + gdb::offset_of_register(gdb::fpscr_number), &floats.fpscr, sizeof floats.fpscr);
  return bytes;
}

void GdbSession::set_all_registers(const std::vector<std::uint8_t>& bytes) {
  CoreRegisters core;
  FloatRegisters floats;
  std::memcpy(core.general.data(), bytes.data(), sizeof core.general);
  std::memcpy(&core.xpsr, bytes.data() + gdb::offset_of_register(gdb::xpsr_number), sizeof core.xpsr);
  std::memcpy(floats.doubles.data(), bytes.data() + gdb::offset_of_register(gdb::first_double), sizeof floats.doubles);
  std::memcpy(&floats.fpscr, bytes.data() + gdb::offset_of_register(gdb::fpscr_number), sizeof floats.fpscr);
  chip_.debug_port().set_core_registers(core);
  chip_.debug_port().set_float_registers(floats);
}

}  // namespace inkwell::virtual_board
