#include "boards/stm32f405/debugger/gdb_requests.hpp"

#include <optional>

#include <fmt/format.h>
#include "boards/stm32f405/debugger/gdb_packets.hpp"

namespace inkwell::virtual_board::gdb {
namespace {

const Answered ok{"OK"}, bad_request{"E01"}, unknown{""};

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

/// "NUMBER,NUMBER"
std::optional<Range> range_of(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto address = number_of(text.substr(0, comma)), bytes = number_of(text.substr(comma + 1));
  if (!address || !bytes) return std::nullopt;
  return Range{*address, *bytes};
}

/// Returns the part of `text` that "OFFSET,LENGTH" selects. The first letter of the reply is `m` if more text follows,
/// otherwise `l`.
Answered part_of(const std::string& text, std::string_view range) {
  const auto part = range_of(range);
  if (!part) return bad_request;
  const auto [offset, length] = *part;
  if (offset >= text.size()) return {"l"};
  return {(text.size() - offset > length ? "m" : "l") + text.substr(offset, length)};
}

Request write_registers(std::string_view digits) {
  auto bytes = bytes_of(digits);
  if (!bytes || bytes->size() != size_of_all_registers) return bad_request;
  return WriteRegisters{std::move(*bytes)};
}

Request read_register(std::string_view digits) {
  const auto number = number_of(digits);
  if (!number || *number >= register_count) return bad_request;
  return ReadRegister{*number};
}

/// "NUMBER=BYTES"
Request write_register(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return bad_request;
  const auto number = number_of(text.substr(0, equals));
  auto bytes = bytes_of(text.substr(equals + 1));
  if (!number || *number >= register_count || !bytes || bytes->size() != size_of_register(*number)) return bad_request;
  return WriteRegister{*number, std::move(*bytes)};
}

Request read_memory(std::string_view text) {
  const auto range = range_of(text);
  if (!range || range->bytes > memory_maximum) return bad_request;
  return ReadMemory{*range};
}

/// "ADDRESS,LENGTH:BYTES"
Request write_memory(std::string_view text, bool is_binary) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return bad_request;
  const auto range = range_of(text.substr(0, colon));
  const std::string_view data = text.substr(colon + 1);
  auto bytes = is_binary ? std::optional(std::vector<std::uint8_t>(data.begin(), data.end())) : bytes_of(data);
  if (!range || !bytes || bytes->size() != range->bytes) return bad_request;
  if (bytes->empty()) return ok;  // GDB tests support for the X packet with empty data
  return WriteMemory{range->address, std::move(*bytes)};
}

/// Parses "zKIND,ADDRESS,LENGTH", optionally with more fields after a semicolon.
Request change_point(std::string_view packet) {
  constexpr std::size_t begin = 3;
  if (packet.size() < begin || packet[2] != ',') return bad_request;
  const auto range = range_of(packet.substr(begin, packet.find(';') - begin));
  if (!range) return bad_request;
  const bool sets = packet[0] == 'Z';
  const char kind = packet[1];
  if (kind == '0' || kind == '1') return ChangeBreakpoint{sets, range->address};
  if (kind < '2' || kind > '4') return unknown;
  return ChangeWatchPoint{sets, kind, *range};
}

Request resume(char action) {
  if (action == 'c' || action == 'C') return Resume{.steps = false};
  if (action == 's' || action == 'S') return Resume{.steps = true};
  return unknown;
}

Request query(std::string_view packet) {
  constexpr std::string_view description = "qXfer:features:read:target.xml:", monitor = "qRcmd,";
  if (packet.starts_with("qSupported"))
    return Answered{
        fmt::format("PacketSize={:x};qXfer:features:read+;QStartNoAckMode+;vContSupported+", 2 * memory_maximum + 64)};
  if (packet.starts_with(description)) return part_of(target_description(), packet.substr(description.size()));
  if (packet == "QStartNoAckMode") return StopAcknowledging{};
  if (packet == "qAttached") return Answered{"1"};
  if (packet == "qC") return Answered{"QC1"};
  if (packet == "qfThreadInfo") return Answered{"m1"};
  if (packet == "qsThreadInfo") return Answered{"l"};
  if (packet.starts_with("qSymbol")) return ok;
  if (!packet.starts_with(monitor)) return unknown;
  const auto command = bytes_of(packet.substr(monitor.size()));
  if (!command) return bad_request;
  return Monitor{{command->begin(), command->end()}};
}

}  // namespace

Request request_of(std::string_view packet) {
  if (packet.empty()) return unknown;
  const std::string_view rest = packet.substr(1);
  switch (packet.front()) {
    case '?': return WhyStopped{};
    case 'g': return ReadRegisters{};
    case 'G': return write_registers(rest);
    case 'p': return read_register(rest);
    case 'P': return write_register(rest);
    case 'm': return read_memory(rest);
    case 'M': return write_memory(rest, false);
    case 'X': return write_memory(rest, true);
    case 'Z':
    case 'z': return change_point(packet);
    case 'c':
    case 's':
      if (!rest.empty()) return unknown;  // resume at another address
      return resume(packet.front());
    case 'C':
    case 'S': return resume(packet.front());
    case 'H':
    case 'T': return ok;
    case 'D': return LetGo{.wants_answer = true};
    case 'k': return LetGo{.wants_answer = false};
    case 'v':
      if (packet == "vCont?") return Answered{"vCont;c;C;s;S"};
      if (packet.starts_with("vCont;") && packet.size() > 6) return resume(packet[6]);
      return unknown;
    case 'q':
    case 'Q': return query(packet);
    default: return unknown;
  }
}

}  // namespace inkwell::virtual_board::gdb
