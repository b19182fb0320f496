// Fuzz targets for data from clients of a virtual board: control socket, USB/IP server and GDB port.
#include <algorithm>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "boards/known/boards.hpp"
#include "boards/stm32f405/core/chip_error.hpp"
#include "boards/stm32f405/debugger/gdb_packets.hpp"
#include "boards/stm32f405/debugger/gdb_requests.hpp"
#include "boards/stm32f405/memory/memory.hpp"
#include "boards/virtual/injection/injection.hpp"
#include "boards/virtual/program/requests.hpp"
#include "boards/virtual/usb/usbip_requests.hpp"
#include "tests/usbip_bytes.hpp"

#include "tests/fuzz/target.hpp"
#include "tests/host/client/firmware_update/made_elf.hpp"

namespace inkwell::fuzz {
namespace {

using nlohmann::json;
using namespace virtual_board;

void check_vector(const Vector3& vector) {
  if (!vector.allFinite()) throw std::logic_error("a vector is not finite");
}

void check_pin(const PinName& pin) {
  if (pin.port < 'A' || pin.port > 'I' || pin.pin > 15) throw std::logic_error("a pin that no chip has");
}

/// Reads all values that the server reads from a request.
void read_values(Command command, const json& values) {
  switch (command) {
    case Command::run: run_time_s(values); break;
    case Command::cut_power: flash_operation(values); break;
    case Command::usb: truth_value(values, "connected"); break;
    case Command::dock: truth_value(values, "docked"); break;
    case Command::buttons: pressed_buttons(values); break;
    case Command::supply: supply_voltage_V(values); break;
    case Command::gimbal: check_vector(gimbal_angles_rad(values)); break;
    case Command::hand: check_vector(hand_request(values).target_m); break;
    case Command::hand_path: {
      double earliest_s = 0.0;
      for (const Waypoint& point : hand_path_request(values)) {
        check_vector(point.target_m);
        if (!(point.after_s >= earliest_s)) throw std::logic_error("a path goes back in time");
        earliest_s = point.after_s;
      }
      break;
    }
    case Command::glitch:
      check_pin(pin_of(values));
      glitch_time_s(values);
      break;
    case Command::pin:
      check_pin(pin_of(values));
      pin_drive(values);
      break;
    case Command::inject:
    case Command::heal: {
      const auto injection = checked(injection_request(values), board::default_board);
      const auto& info = protocol::info(injection.fault);
      if (!(injection.amount >= info.minimum && injection.amount <= info.maximum))
        throw std::logic_error("an amount outside of its range");
      break;
    }
    case Command::meter: meter_action(values); break;
    case Command::trace:
      trace_action(values);
      trace_rows(values);
      break;
    case Command::status:
    case Command::truth:
    case Command::pause:
    case Command::stand_by:
    case Command::resume:
    case Command::reset:
    case Command::quit: break;
  }
}

const Registered control_requests{
    "control_requests", [](Input input) {
      refuse_or_take<Refused>([&] {
        const auto request = read_request(text_of(input));
        refuse_or_take<InvalidInjection>([&] { read_values(request.info->command, request.values); });
      });
    }};

/// Fuzz target for firmware images of a virtual board. The memory is not cleared between two images.
const Registered board_image{"board_image",
                             [](Input input) {
                               static Memory memory;
                               const std::string file = text_of(input);
                               refuse_or_take<ChipError>([&] {
                                 program_elf(file, "any.elf", memory);
                                 const std::uint32_t first_instruction = memory.word(flash_base + 4);
                                 if ((first_instruction & 1) == 0 || memory.at(first_instruction & ~1u, 2) == nullptr)
                                   throw std::logic_error("an image was taken that cannot start");
                               });
                             },
                             [] { return std::vector<Bytes>{tests::made_elf(tests::made_segments({}))}; }};

/// The input is a command line or a fault script.
const Registered injections{
    "injections", [](Input input) {
      refuse_or_take<InvalidInjection>([&] { parse_injections(text_of(input), board::default_board); });
    }};

/// Passes the bytes to `take` in pieces of at most this length.
template <class Take>
void in_pieces(std::string_view bytes, std::size_t most, Take take) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min(most, bytes.size()))) take(bytes.substr(0, most));
}

// ---- USB/IP ----

void note(std::string& seen, std::span<const std::byte> bytes) {
  seen.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void note(std::string& seen, std::initializer_list<std::uint32_t> values) {
  note(seen, std::as_bytes(std::span(values.begin(), values.size())));
}

void note(std::string& seen, const Urb& urb) {
  if (urb.length > transfer_maximum || urb.endpoint > 15 || urb.packets.size() > packets_maximum ||
      urb.data.size() != (urb.in ? 0 : urb.length))
    throw std::logic_error("a transfer that cannot be");
  note(seen, {urb.sequence, urb.endpoint, urb.in, urb.flags, urb.length});
  note(seen, urb.setup);
  note(seen, urb.data);
  for (const auto& packet : urb.packets) note(seen, {packet.offset, packet.length});
}

/// Parses the bytes of a client like the server and returns the found requests.
std::string found_in(std::string_view bytes, std::size_t piece) {
  std::string seen;
  UsbIpRequests requests;
  bool has_imported = false;
  const auto take_operation = [&] {
    const auto operation = requests.take_operation();
    if (!operation) return false;
    if (const auto* const import = std::get_if<UsbIpRequests::Import>(&*operation)) {
      if (bytes.find(import->bus_id) == std::string_view::npos) throw std::logic_error("a name that was never sent");
      seen += "import " + import->bus_id;
      has_imported = true;
    } else {
      seen += "list";
    }
    return true;
  };
  const auto take_transfer = [&] {
    const auto transfer = requests.take_transfer();
    if (!transfer) return false;
    if (const auto* const unlink = std::get_if<UsbIpRequests::Unlink>(&*transfer))
      note(seen, {unlink->sequence, unlink->unlinked_sequence});
    else
      note(seen, std::get<Urb>(*transfer));
    return true;
  };
  try {
    in_pieces(bytes, piece, [&](std::string_view part) {
      requests.feed(std::as_bytes(std::span(part)));
      while (has_imported ? take_transfer() : take_operation()) {
      }
    });
  } catch (const std::runtime_error& refused) {
    seen += refused.what();
  }
  return seen;
}

/// Returns the messages as an input with a piece length of one byte.
template <class... Messages>
Bytes one_by_one(const Messages&... messages) {
  Bytes bytes = tests::joined(messages...);
  bytes.insert(bytes.begin(), std::byte{0});
  return bytes;
}

std::vector<Bytes> usbip_examples() {
  usbip::Submit submit{.length = 18};
  submit.header.device = usbip::device_of(exported_bus_number, exported_device_number);
  submit.header.direction = usbip::Direction::in;
  submit.setup = {std::byte{0x80}, std::byte{6}, std::byte{0}, std::byte{1}};
  usbip::Submit out = submit;
  out.header.direction = usbip::Direction::out;
  out.header.endpoint = 1;
  out.packet_count = 1;
  const usbip::IsochronousPacket data{.offset = 1, .length = 2}, packet{.offset = 3, .length = 4};
  out.length = sizeof data;
  usbip::Unlink unlink{.unlinked_sequence = 1};
  unlink.header.device = submit.header.device;
  const usbip::OperationHeader list{.operation = usbip::Operation::request_device_list};
  const usbip::ImportRequest import{.bus_id = {exported_bus_id}};
  return {one_by_one(list, import), one_by_one(import, submit, unlink), one_by_one(import, out, data, packet, submit)};
}

/// The first byte sets the length of the pieces, which must not change the result.
const Registered usbip_requests{"usbip_requests",
                                [](Input input) {
                                  if (input.empty()) return;
                                  const std::size_t piece = 1 + std::to_integer<std::size_t>(input[0]);
                                  const std::string bytes = text_of(input.subspan(1));
                                  if (found_in(bytes, piece) != found_in(bytes, bytes.size()))
                                    throw std::logic_error("it matters how the bytes arrive");
                                },
                                usbip_examples};

// ---- GDB ----

struct Checked {
  std::size_t packet_size;
  void operator()(const gdb::Answered& answered) const {
    GdbPackets packets;
    packets.feed(gdb_packet(answered.reply));
    const auto received = packets.take();
    if (!received || received->kind != GdbPackets::Received::Kind::packet || received->payload != answered.reply)
      throw std::logic_error("an answer that GDB cannot read");
  }
  void operator()(const gdb::WriteRegisters& asked) const {
    if (asked.bytes.size() != gdb::size_of_all_registers) throw std::logic_error("registers are missing");
  }
  void operator()(const gdb::ReadRegister& asked) const {
    if (asked.number >= gdb::register_count) throw std::logic_error("a register that is not there");
  }
  void operator()(const gdb::WriteRegister& asked) const {
    if (asked.number >= gdb::register_count || asked.bytes.size() != gdb::size_of_register(asked.number))
      throw std::logic_error("a register that is not there, or not all of it");
  }
  void operator()(const gdb::ReadMemory& asked) const {
    if (asked.range.bytes > gdb::memory_maximum) throw std::logic_error("more than a packet holds");
  }
  void operator()(const gdb::WriteMemory& asked) const {
    if (asked.bytes.empty() || asked.bytes.size() > packet_size) throw std::logic_error("bytes out of nothing");
  }
  void operator()(const gdb::ChangeWatchPoint& asked) const {
    if (asked.kind < '2' || asked.kind > '4') throw std::logic_error("a watch point of no kind");
  }
  void operator()(const auto&) const {}
};

void check_packet(std::string_view packet) { std::visit(Checked{packet.size()}, gdb::request_of(packet)); }

/// Returns the payloads of all packets, one per line.
std::string packets_in(std::string_view bytes, std::size_t piece) {
  std::string found;
  GdbPackets packets;
  in_pieces(bytes, piece, [&](std::string_view part) {
    packets.feed(part);
    while (const auto received = packets.take()) {
      check_packet(received->payload);
      found += static_cast<char>('0' + static_cast<int>(received->kind)) + received->payload + '\n';
    }
  });
  return found;
}

std::vector<Bytes> gdb_examples() {
  std::vector<Bytes> all;
  const std::string all_registers = "G" + std::string(2 * gdb::size_of_all_registers, '7');
  const std::string_view packets[] = {"?",
                                      "g",
                                      "p10",
                                      "P0=2a000000",
                                      "m20000000,4",
                                      "M20000000,2:2a00",
                                      "X20000000,2:ab",
                                      "Z0,8000000,2",
                                      "z2,20000000,4",
                                      "c",
                                      "vCont;s:1",
                                      "D;1",
                                      "k",
                                      "p21",
                                      "z1,8000000,2",
                                      "vCont;C05",
                                      "qSupported:xmlRegisters=arm",
                                      "qXfer:features:read:target.xml:0,40",
                                      "QStartNoAckMode",
                                      "qRcmd,7265736574",
                                      "P11=0123456789abcdef",
                                      all_registers};
  for (const std::string_view packet : packets) {
    all.push_back(bytes_of(std::string(1, '\0') += packet));
    all.push_back(bytes_of("\x05+" + gdb_packet(packet) + "\x03" + gdb_packet(packet)));
  }
  return all;
}

/// A first byte of 0 marks a single packet without a frame. Any other first byte is the length of the pieces of a byte
/// stream.
const Registered gdb_requests{
    "gdb_requests",
    [](Input input) {
      if (input.empty()) return;
      const auto piece = std::to_integer<std::size_t>(input[0]);
      const std::string bytes = text_of(input.subspan(1));
      if (piece > 0) {
        if (packets_in(bytes, piece) != packets_in(bytes, bytes.size()))
          throw std::logic_error("it matters how the bytes arrive");
        return;
      }
      check_packet(bytes);
      GdbPackets packets;
      packets.feed(gdb_packet(bytes));
      const auto received = packets.take();
      if (!received || received->kind != GdbPackets::Received::Kind::packet || received->payload != bytes)
        throw std::logic_error("a packet is not what was put into it");
    },
    gdb_examples};

}  // namespace
}  // namespace inkwell::fuzz
