#include <algorithm>
#include <cstring>
#include <debugger/gdb_session.hpp>

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

constexpr unsigned signal_interrupt = 2, signal_trap = 5, signal_fault = 11;
constexpr std::uint32_t memory_maximum = 0x2000;  ///< bytes of a packet
constexpr const char *bad_request = "E01", *no_memory = "E0e", *unknown = "";

/// Place of each register in the packets g and p: as in the description of the target.
constexpr unsigned xpsr_number = 16, first_double = 17, fpscr_number = 33, register_count = 34;
constexpr std::size_t size_of_register(unsigned number) {
  return number >= first_double && number < fpscr_number ? 8 : 4;
}
constexpr std::size_t place_of_register(unsigned number) {
  std::size_t place = 0;
  for (unsigned i = 0; i < number; ++i) place += size_of_register(i);
  return place;
}

std::string target_description() {
  std::string text = R"(<?xml version="1.0"?><!DOCTYPE target SYSTEM "gdb-target.dtd"><target version="1.0">)"
                     R"(<architecture>arm</architecture><feature name="org.gnu.gdb.arm.m-profile">)";
  for (unsigned i = 0; i <= 12; ++i) text += fmt::format(R"(<reg name="r{}" bitsize="32"/>)", i);
  text += R"(<reg name="sp" bitsize="32" type="data_ptr"/><reg name="lr" bitsize="32"/>)"
          R"(<reg name="pc" bitsize="32" type="code_ptr"/><reg name="xpsr" bitsize="32"/></feature>)"
          R"(<feature name="org.gnu.gdb.arm.vfp">)";
  for (unsigned i = 0; i < 16; ++i) text += fmt::format(R"(<reg name="d{}" bitsize="64" type="ieee_double"/>)", i);
  return text + R"(<reg name="fpscr" bitsize="32" type="int" group="float"/></feature></target>)";
}

/// The part of `text` that "OFFSET,LENGTH" asks for, with the mark whether more follows.
std::string part_of(const std::string& text, std::string_view range) {
  const auto comma = range.find(',');
  if (comma == std::string_view::npos) return bad_request;
  const auto offset = number_of(range.substr(0, comma)), length = number_of(range.substr(comma + 1));
  if (!offset || !length) return bad_request;
  if (*offset >= text.size()) return "l";
  return (text.size() - *offset > *length ? "m" : "l") + text.substr(*offset, *length);
}

struct Range {
  std::uint32_t address, bytes;
};
/// "ADDRESS,LENGTH"
std::optional<Range> range_of(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto address = number_of(text.substr(0, comma)), bytes = number_of(text.substr(comma + 1));
  if (!address || !bytes) return std::nullopt;
  return Range{*address, *bytes};
}

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
    const std::string reply = answer(received->payload);
    if (attached_ && halted_) out += gdb_packet(reply);
    if (received->payload.starts_with('D')) out += gdb_packet("OK");
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

std::string GdbSession::answer(std::string_view packet) {
  const char kind = packet.empty() ? '\0' : packet.front();
  const std::string_view rest = packet.substr(packet.empty() ? 0 : 1);
  switch (kind) {
    case '?': return stop_reply(signal_trap);
    case 'g': return hexadecimal(all_registers());
    case 'G': {
      const auto bytes = bytes_of(rest);
      return bytes && set_all_registers(*bytes) ? "OK" : bad_request;
    }
    case 'p': {
      const auto number = number_of(rest);
      if (!number || *number >= register_count) return bad_request;
      const auto all = all_registers();
      return hexadecimal(std::span(all).subspan(place_of_register(*number), size_of_register(*number)));
    }
    case 'P': {
      const auto equals = rest.find('=');
      if (equals == std::string_view::npos) return bad_request;
      const auto number = number_of(rest.substr(0, equals));
      const auto bytes = bytes_of(rest.substr(equals + 1));
      if (!number || *number >= register_count || !bytes || bytes->size() != size_of_register(*number))
        return bad_request;
      auto all = all_registers();
      std::copy(bytes->begin(), bytes->end(), all.begin() + static_cast<std::ptrdiff_t>(place_of_register(*number)));
      return set_all_registers(all) ? "OK" : bad_request;
    }
    case 'm': return read_memory(rest);
    case 'M': return write_memory(rest, false);
    case 'X': return write_memory(rest, true);
    case 'Z':
    case 'z': return change_point(packet);
    case 'c':
    case 's':
      if (!rest.empty()) return unknown;
      return resume(kind);
    case 'C': return resume('c');
    case 'S': return resume('s');
    case 'H':
    case 'T': return "OK";
    case 'D':
    case 'k': detach(); return {};
    case 'v':
      if (packet == "vCont?") return "vCont;c;C;s;S";
      if (packet.starts_with("vCont;") && packet.size() > 6) return resume(packet[6] | 0x20);
      return unknown;
    case 'q':
    case 'Q': return answer_query(packet);
    default: return unknown;
  }
}

std::string GdbSession::answer_query(std::string_view packet) {
  constexpr std::string_view description = "qXfer:features:read:target.xml:", monitor = "qRcmd,";
  if (packet.starts_with("qSupported"))
    return fmt::format("PacketSize={:x};qXfer:features:read+;QStartNoAckMode+;vContSupported+",
                       2 * memory_maximum + 64);
  if (packet.starts_with(description)) return part_of(target_description(), packet.substr(description.size()));
  if (packet == "QStartNoAckMode") {
    acknowledges_ = false;
    return "OK";
  }
  if (packet == "qAttached") return "1";
  if (packet == "qC") return "QC1";
  if (packet == "qfThreadInfo") return "m1";
  if (packet == "qsThreadInfo") return "l";
  if (packet.starts_with("qSymbol")) return "OK";
  if (packet.starts_with(monitor)) {
    const auto command = bytes_of(packet.substr(monitor.size()));
    return command ? answer_monitor({reinterpret_cast<const char*>(command->data()), command->size()}) : bad_request;
  }
  return unknown;
}

std::string GdbSession::answer_monitor(std::string_view command) {
  if (command == "reset" || command == "reset halt") {
    chip_.reset();
    return "OK";
  }
  if (command == "time") return hexadecimal(fmt::format("{:.9f} s of board time\n", seconds(chip_.now())));
  return hexadecimal(
      std::string_view("monitor reset: reset the chip and stop at its first instruction\n"
                       "monitor time: board time\n"));
}

std::string GdbSession::resume(char action) {
  if (action != 'c' && action != 's') return unknown;
  if (action == 's')
    chip_.debug_port().step();
  else
    chip_.debug_port().resume();
  halted_ = false;
  return {};
}

std::string GdbSession::change_point(std::string_view packet) {
  if (packet.size() < 3 || packet[2] != ',') return bad_request;
  const char kind = packet[1];
  const auto range = range_of(packet.substr(3, packet.find(';') - 3));
  if (!range) return bad_request;
  auto& port = chip_.debug_port();
  const bool sets = packet[0] == 'Z';
  if (kind == '0' || kind == '1') {
    sets ? port.add_breakpoint(range->address) : port.remove_breakpoint(range->address);
    return "OK";
  }
  if (kind < '2' || kind > '4') return unknown;
  const WatchPoint place{range->address, range->bytes, kind != '2', kind != '3'};
  const auto found = std::find_if(watched_.begin(), watched_.end(), [&](const Watched& watched) {
    return watched.place == place && watched.kind == kind;
  });
  if (sets && found == watched_.end()) {
    port.add_watch_point(place);
    watched_.push_back({place, kind});
  } else if (!sets && found != watched_.end()) {
    port.remove_watch_point(place);
    watched_.erase(found);
  }
  return "OK";
}

std::string GdbSession::read_memory(std::string_view packet) {
  const auto range = range_of(packet);
  if (!range || range->bytes > memory_maximum) return bad_request;
  std::vector<std::uint8_t> bytes(range->bytes);
  return chip_.debug_port().read(range->address, bytes) ? hexadecimal(bytes) : no_memory;
}

std::string GdbSession::write_memory(std::string_view packet, bool binary) {
  const auto colon = packet.find(':');
  if (colon == std::string_view::npos) return bad_request;
  const auto range = range_of(packet.substr(0, colon));
  const std::string_view data = packet.substr(colon + 1);
  const auto bytes = binary ? std::optional(std::vector<std::uint8_t>(data.begin(), data.end())) : bytes_of(data);
  if (!range || !bytes || bytes->size() != range->bytes) return bad_request;
  return bytes->empty() || chip_.debug_port().write(range->address, *bytes) ? "OK" : no_memory;
}

std::vector<std::uint8_t> GdbSession::all_registers() const {
  const auto core = chip_.debug_port().core_registers();
  const auto floats = chip_.debug_port().float_registers();
  std::vector<std::uint8_t> bytes(place_of_register(register_count));
  std::memcpy(bytes.data(), core.general.data(), sizeof core.general);
  std::memcpy(bytes.data() + place_of_register(xpsr_number), &core.xpsr, sizeof core.xpsr);
  std::memcpy(bytes.data() + place_of_register(first_double), floats.doubles.data(), sizeof floats.doubles);
  std::memcpy(bytes.data() + place_of_register(fpscr_number), &floats.fpscr, sizeof floats.fpscr);
  return bytes;
}

bool GdbSession::set_all_registers(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() != place_of_register(register_count)) return false;
  CoreRegisters core;
  FloatRegisters floats;
  std::memcpy(core.general.data(), bytes.data(), sizeof core.general);
  std::memcpy(&core.xpsr, bytes.data() + place_of_register(xpsr_number), sizeof core.xpsr);
  std::memcpy(floats.doubles.data(), bytes.data() + place_of_register(first_double), sizeof floats.doubles);
  std::memcpy(&floats.fpscr, bytes.data() + place_of_register(fpscr_number), sizeof floats.fpscr);
  chip_.debug_port().set_core_registers(core);
  chip_.debug_port().set_float_registers(floats);
  return true;
}

}  // namespace inkwell::virtual_board
