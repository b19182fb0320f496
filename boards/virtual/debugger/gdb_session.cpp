#include <algorithm>
#include <cstring>
#include <debugger/gdb_session.hpp>

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
    const std::string reply = std::visit([this](const auto& asked) { return carry_out(asked); }, request);
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
  for (const auto& [place, kind] : watched_)
    if (stop.address - place.address < place.bytes) {
      const char* name = kind == '2' ? "watch" : kind == '3' ? "rwatch" : "awatch";
      return reply + fmt::format("{}:{:x};", name, place.address);
    }
  return reply;
}

std::string GdbSession::carry_out(const gdb::Answered& asked) { return asked.reply; }

std::string GdbSession::carry_out(gdb::WhyStopped) { return stop_reply(signal_trap); }

std::string GdbSession::carry_out(gdb::ReadRegisters) { return hexadecimal(all_registers()); }

std::string GdbSession::carry_out(const gdb::WriteRegisters& asked) {
  set_all_registers(asked.bytes);
  return ok;
}

std::string GdbSession::carry_out(gdb::ReadRegister asked) {
  const auto all = all_registers();
  return hexadecimal(std::span(all).subspan(gdb::place_of_register(asked.number), gdb::size_of_register(asked.number)));
}

std::string GdbSession::carry_out(const gdb::WriteRegister& asked) {
  auto all = all_registers();
  std::ranges::copy(asked.bytes, all.begin() + static_cast<std::ptrdiff_t>(gdb::place_of_register(asked.number)));
  set_all_registers(all);
  return ok;
}

std::string GdbSession::carry_out(gdb::ReadMemory asked) {
  std::vector<std::uint8_t> bytes(asked.range.bytes);
  return chip_.debug_port().read(asked.range.address, bytes) ? hexadecimal(bytes) : no_memory;
}

std::string GdbSession::carry_out(const gdb::WriteMemory& asked) {
  return chip_.debug_port().write(asked.address, asked.bytes) ? ok : no_memory;
}

std::string GdbSession::carry_out(gdb::ChangeBreakpoint asked) {
  auto& port = chip_.debug_port();
  asked.sets ? port.add_breakpoint(asked.address) : port.remove_breakpoint(asked.address);
  return ok;
}

std::string GdbSession::carry_out(gdb::ChangeWatchPoint asked) {
  auto& port = chip_.debug_port();
  const WatchPoint place{asked.range.address, asked.range.bytes, asked.kind != '2', asked.kind != '3'};
  const auto found = std::ranges::find_if(
      watched_, [&](const Watched& watched) { return watched.place == place && watched.kind == asked.kind; });
  if (asked.sets && found == watched_.end()) {
    port.add_watch_point(place);
    watched_.push_back({place, asked.kind});
  } else if (!asked.sets && found != watched_.end()) {
    port.remove_watch_point(place);
    watched_.erase(found);
  }
  return ok;
}

std::string GdbSession::carry_out(gdb::Resume asked) {
  asked.steps ? chip_.debug_port().step() : chip_.debug_port().resume();
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

std::string GdbSession::carry_out(const gdb::Monitor& asked) {
  if (asked.command == "reset" || asked.command == "reset halt") {
    chip_.reset();
    return ok;
  }
  if (asked.command == "time") return hexadecimal(fmt::format("{:.9f} s of board time\n", seconds(chip_.now())));
  return hexadecimal(
      std::string_view("monitor reset: reset the chip and stop at its first instruction\n"
                       "monitor time: print board time\n"));
}

std::vector<std::uint8_t> GdbSession::all_registers() const {
  const auto core = chip_.debug_port().core_registers();
  const auto floats = chip_.debug_port().float_registers();
  std::vector<std::uint8_t> bytes(gdb::size_of_all_registers);
  std::memcpy(bytes.data(), core.general.data(), sizeof core.general);
  std::memcpy(bytes.data() + gdb::place_of_register(gdb::xpsr_number), &core.xpsr, sizeof core.xpsr);
  std::memcpy(bytes.data() + gdb::place_of_register(gdb::first_double), floats.doubles.data(), sizeof floats.doubles);
  std::memcpy(bytes.data() + gdb::place_of_register(gdb::fpscr_number), &floats.fpscr, sizeof floats.fpscr);
  return bytes;
}

void GdbSession::set_all_registers(const std::vector<std::uint8_t>& bytes) {
  CoreRegisters core;
  FloatRegisters floats;
  std::memcpy(core.general.data(), bytes.data(), sizeof core.general);
  std::memcpy(&core.xpsr, bytes.data() + gdb::place_of_register(gdb::xpsr_number), sizeof core.xpsr);
  std::memcpy(floats.doubles.data(), bytes.data() + gdb::place_of_register(gdb::first_double), sizeof floats.doubles);
  std::memcpy(&floats.fpscr, bytes.data() + gdb::place_of_register(gdb::fpscr_number), sizeof floats.fpscr);
  chip_.debug_port().set_core_registers(core);
  chip_.debug_port().set_float_registers(floats);
}

}  // namespace inkwell::virtual_board
