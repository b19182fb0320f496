// Tests the device over USB/IP on a loopback socket.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <list>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "boards/virtual/usb/client_name.hpp"
#include "tests/failure.hpp"
#include "tests/plain_client.hpp"
#include "tests/temporary_directory.hpp"

#include "tests/boards/virtual/usb/usbip_client.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using usbip::Command;
using usbip::OperationStatus;

constexpr std::array<std::uint8_t, 8> get_device_descriptor{0x80, 6, 0, 1, 0, 0, 18, 0};
constexpr std::array<std::uint8_t, 8> set_configuration{0x00, 9, 5, 0, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> set_address{0x00, 5, 77, 0, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 8> unknown_request{0xC0, 99, 0, 0, 0, 0, 8, 0};
constexpr std::array<std::uint8_t, 8> store_100_bytes{0x40, 2, 0, 0, 0, 0, 100, 0};

void configure(UsbIpClient& client, std::uint32_t sequence = 1) {
  client.submit(sequence, 0, false, 0, {}, set_configuration);
  const auto reply = client.read_reply();
  REQUIRE(reply.header.command == Command::return_submit);
  REQUIRE(reply.header.sequence == sequence);
  REQUIRE(reply.status == 0);
}

usbip::ReturnSubmit ask_for_device_descriptor(UsbIpClient& client) {
  client.submit(7, 0, true, 18, {}, get_device_descriptor);
  const auto reply = client.read_reply();
  REQUIRE(reply.header.sequence == 7);
  REQUIRE(reply.status == 0);
  return reply;
}

TEST_CASE("the device list contains the descriptors after the enumeration") {
  LiveBoard board;
  board.call([&] { board.usb.disconnect(); });
  {
    UsbIpClient client(board.usb.port());
    client.ask_for_list();
    const auto empty = client.receive<usbip::DeviceListReply>();
    CHECK(empty.header.operation == usbip::Operation::reply_device_list);
    CHECK(empty.device_count == 0);
  }
  board.call([&] { board.usb.connect(); });
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  client.ask_for_list();
  const auto list = client.receive<usbip::DeviceListReply>();
  CHECK(list.header.version == 0x0111);
  CHECK(list.header.status == OperationStatus::success);
  REQUIRE(list.device_count == 1);
  const auto device = client.receive<usbip::Device>();
  CHECK(device.path.view() == "/sys/devices/platform/inkwell_virtual_board/usb1/1-1");
  CHECK(device.bus_id.view() == "1-1");
  CHECK(device.bus_number == 1);
  CHECK(device.device_number == 2);
  CHECK(device.speed == usbip::Speed::full);
  CHECK(device.vendor_id == 0x1209);
  CHECK(device.product_id == 0x0001);
  CHECK(device.device_release == 0x0134);
  CHECK(device.configuration == 0);
  CHECK(device.configuration_count == 1);
  REQUIRE(device.interface_count == 2);
  CHECK(client.receive<usbip::Interface>().interface_class == 3);  // HID
  const auto vendor = client.receive<usbip::Interface>();
  CHECK(vendor.interface_class == 0xFF);
  CHECK(vendor.interface_subclass == 1);
  CHECK(vendor.interface_protocol == 2);
}

TEST_CASE("control transfers and errors over the socket") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  auto reply = ask_for_device_descriptor(client);
  CHECK(reply.header.command == Command::return_submit);
  REQUIRE(reply.actual_length == 18);
  const Bytes descriptor = client.receive(18);
  CHECK(descriptor[0] == std::byte{18});
  CHECK(descriptor[8] == std::byte{0x09});

  client.submit(8, 0, true, 8, {}, unknown_request);
  reply = client.read_reply();
  CHECK(reply.header.sequence == 8);
  CHECK(reply.status == -32);
  CHECK(reply.actual_length == 0);

  Bytes data(100);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = pattern(i);
  client.submit(9, 0, false, 100, data, store_100_bytes);
  reply = client.read_reply();
  CHECK(reply.status == 0);
  CHECK(reply.actual_length == 100);
  board.call([&] { CHECK(board.firmware.control_received == data); });

  client.submit(10, 0, false, 0, {}, set_address);  // answered, but the device keeps the port's address
  CHECK(client.read_reply().status == 0);
  board.call([&] { CHECK(board.firmware.address == 2); });

  client.submit(11, 2, true, 64);
  CHECK(client.read_reply().status == -22);
  board.call([&] { CHECK(board.log.sentences.empty()); });
}

TEST_CASE("one importer too many and an unknown device are refused, and a later importer is accepted") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  {
    std::list<UsbIpClient> importers;
    for (int i = 0; i < 8; ++i) REQUIRE(importers.emplace_back(board.usb.port()).import() == OperationStatus::success);
    UsbIpClient another(board.usb.port());
    CHECK(another.import() == OperationStatus::busy);
    CHECK(another.closed());
    UsbIpClient third(board.usb.port());
    CHECK(third.import("2-1") == OperationStatus::no_device);
    CHECK(third.closed());
    configure(importers.front());
  }
  REQUIRE(board.wait_until_enumerated());  // the release has arrived by this time
  unsigned resets = 0;
  board.call([&] { resets = board.firmware.resets; });
  for (int i = 0; i < 3; ++i) {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient next(board.usb.port());
    REQUIRE(next.import() == OperationStatus::success);
    configure(next);
  }
  board.call([&] { CHECK(board.firmware.resets == resets + 3); });
}

TEST_CASE("64 bulk transfers deep, nothing lost") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
  constexpr std::uint32_t length = 1024;
  std::uint32_t submitted_count = 0;
  for (; submitted_count < 64; ++submitted_count) client.submit(100 + submitted_count, 2, true, length);
  std::uint32_t expected = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const auto reply = client.read_reply();
    REQUIRE(reply.header.sequence == 100 + i);
    REQUIRE(reply.actual_length == length);
    const Bytes data = client.receive(length);
    for (std::size_t at = 0; at < length; at += 4) {
      std::uint32_t word = 0;
      std::memcpy(&word, data.data() + at, 4);
      REQUIRE(word == expected++);
    }
    client.submit(100 + submitted_count++, 2, true, length);
  }
}

TEST_CASE(
    "a host that stops in the middle of a stream does not hold up the board's end, nor if it takes a request back") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
  board.pause(true);
  for (const std::uint32_t sequence : {30u, 31u}) client.submit(sequence, 2, true, 64);
  board.call([&] { board.usb.settle(); });  // both requests arrive before the first is answered
  board.pause(false);
  for (int i = 0; i < 2; ++i) REQUIRE(client.receive(client.read_reply().actual_length).size() == 64);
  SUBCASE("the client unlinks the last transfer too late") {
    client.unlink(32, 31);
    CHECK(client.receive<usbip::ReturnUnlink>().header.sequence == 32);
  }
  SUBCASE("the board ends") { board.is_ending = true; }
  const auto before = board.scheduler.now();
  for (int i = 0; i < 2; ++i) board.call([] {});  // waits until the board's thread is free again
  CHECK(board.scheduler.now() > before);
}

TEST_CASE("an unlinked transfer has only the answer to the unlink request") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
  client.submit(20, 1, true, 64);
  client.submit(21, 1, true, 64);
  client.unlink(22, 20);
  auto unlinked = client.receive<usbip::ReturnUnlink>();
  CHECK(unlinked.header.command == Command::return_unlink);
  CHECK(unlinked.header.sequence == 22);
  CHECK(unlinked.status == -104);
  const Bytes report(10, std::byte{42});
  board.call([&] { board.firmware.send_report(report); });
  const auto reply = client.read_reply();
  CHECK(reply.header.command == Command::return_submit);
  CHECK(reply.header.sequence == 21);
  CHECK(client.receive(reply.actual_length) == report);
  client.unlink(23, 21);  // too late: already answered
  unlinked = client.receive<usbip::ReturnUnlink>();
  CHECK(unlinked.header.command == Command::return_unlink);
  CHECK(unlinked.header.sequence == 23);
  CHECK(unlinked.status == 0);
  client.submit(20, 0, true, 18, {}, get_device_descriptor);  // the sequence number is free again
  CHECK(client.read_reply().header.sequence == 20);
}

TEST_CASE("unplug closes the importer's connection; after replug it can import again") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  {
    UsbIpClient client(board.usb.port());
    REQUIRE(client.import() == OperationStatus::success);
    configure(client);
    client.submit(30, 1, true, 64);
    board.call([&] { board.usb.disconnect(); });
    CHECK(client.closed());
    UsbIpClient other(board.usb.port());
    CHECK(other.import() == OperationStatus::no_device);
  }
  board.call([&] { board.usb.connect(); });
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
  client.submit(31, 2, true, 64);
  CHECK(client.read_reply().actual_length == 64);
}

TEST_CASE("while the simulation is paused, lists and imports are answered and transfers wait") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  board.pause(true);
  UsbIpClient client(board.usb.port());
  client.ask_for_list();
  CHECK(client.receive(12 + 312 + 8).size() == 12 + 312 + 8);
  REQUIRE(client.import() == OperationStatus::success);
  client.submit(40, 0, true, 18, {}, get_device_descriptor);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  board.call([&] { CHECK(board.firmware.resets == 2); });
  board.pause(false);
  CHECK(client.read_reply().header.sequence == 40);
}

TEST_CASE("isochronous transfers are not modeled and return errors, and the connection stays open") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
  std::uint32_t sequence = 10;
  for (const bool in : {false, true}) {
    constexpr std::uint32_t packets = 3, packet_bytes = 192;
    usbip::Submit submit{.length = packets * packet_bytes, .packet_count = packets};
    submit.header.sequence = ++sequence;
    submit.header.device = exported_device;
    submit.header.direction = in ? usbip::Direction::in : usbip::Direction::out;
    submit.header.endpoint = 4;
    client.send(usbip::bytes_of(submit));
    if (!in) client.send(Bytes(packets * packet_bytes));
    for (std::uint32_t i = 0; i < packets; ++i)
      client.send(usbip::bytes_of(usbip::IsochronousPacket{.offset = i * packet_bytes, .length = packet_bytes}));
    const auto reply = client.read_reply();
    CHECK(reply.header.sequence == sequence);
    CHECK(reply.status == -22);
    CHECK(reply.actual_length == 0);
    CHECK(reply.packet_count == packets);
    CHECK(reply.error_count == packets);
    for (std::uint32_t i = 0; i < packets; ++i) {
      const auto packet = client.receive<usbip::IsochronousPacket>();
      CHECK(packet.offset == i * packet_bytes);
      CHECK(packet.length == packet_bytes);
      CHECK(packet.actual_length == 0);
      CHECK(packet.status == -22);
    }
  }
  client.submit(20, 0, true, 18, {}, get_device_descriptor);
  CHECK(client.read_reply().status == 0);
}

TEST_CASE("nonsense closes the connection, not the server") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  const std::uint16_t port = board.usb.port();
  {
    UsbIpClient client(port);
    client.send(
        usbip::bytes_of(usbip::OperationHeader{.version = 0x0100, .operation = usbip::Operation::request_device_list}));
    CHECK(client.closed());
  }
  {
    UsbIpClient client(port);
    client.send(usbip::bytes_of(usbip::OperationHeader{.operation = static_cast<usbip::Operation>(0x8888)}));
    CHECK(client.closed());
  }
  usbip::Submit valid{.length = 18};
  valid.header = {Command::submit, 1, exported_device, usbip::Direction::in, 0};
  std::memcpy(valid.setup.data(), get_device_descriptor.data(), valid.setup.size());
  const std::vector<std::function<void(usbip::Submit&)>> mistakes{
      [](usbip::Submit& submit) { submit.header.command = static_cast<Command>(9); },
      [](usbip::Submit& submit) { submit.header.device = exported_device + 1; },
      [](usbip::Submit& submit) { submit.header.direction = static_cast<usbip::Direction>(2); },
      [](usbip::Submit& submit) { submit.header.endpoint = 16; },
      [](usbip::Submit& submit) { submit.length = 0xFFFF'FFF0; },
      [](usbip::Submit& submit) {
        submit.header.endpoint = 2;
        submit.header.direction = usbip::Direction::out;
        submit.length = 0x7FFF'FFFF;
      },
      [](usbip::Submit& submit) { submit.packet_count = 1025; },                        // too many
      [](usbip::Submit& submit) { submit.header.direction = usbip::Direction::out; }};  // contradicts the direction IN
                                                                                        // of the request
  for (const auto& make : mistakes) {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == OperationStatus::success);
    usbip::Submit submit = valid;
    make(submit);
    client.send(usbip::bytes_of(submit));
    CHECK(client.closed());
  }
  {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == OperationStatus::success);
    configure(client);
    client.submit(50, 1, true, 64);
    client.submit(50, 1, true, 64);  // repeated sequence number
    CHECK(client.closed());
  }
  {
    REQUIRE(board.wait_until_enumerated());
    UsbIpClient client(port);
    REQUIRE(client.import() == OperationStatus::success);
    client.send(Bytes(20));  // half a command, then the connection closes
  }
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(port);
  REQUIRE(client.import() == OperationStatus::success);
  configure(client);
}

TEST_CASE("a client is served immediately after another client exited with pending transfers") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  for (int i = 0; i < 20; ++i) {
    auto dying = std::make_unique<UsbIpClient>(board.usb.port());
    while (dying->import() != OperationStatus::success) dying = std::make_unique<UsbIpClient>(board.usb.port());
    for (std::uint32_t sequence = 1; sequence <= 64; ++sequence)
      dying->submit(sequence, 0, true, 18, {}, get_device_descriptor);
    UsbIpClient next(board.usb.port());
    dying.reset();
    const auto status = next.import();
    if (status != OperationStatus::success) continue;  // accepted before the server detected the closed connection
    ask_for_device_descriptor(next);
  }
}

TEST_CASE("idle clients do not prevent another client from connecting, and the importer stays connected") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient importer(board.usb.port());
  REQUIRE(importer.import() == OperationStatus::success);
  std::vector<std::unique_ptr<UsbIpClient>> idle;
  for (int i = 0; i < 40; ++i) idle.push_back(std::make_unique<UsbIpClient>(board.usb.port()));
  UsbIpClient another(board.usb.port());
  another.ask_for_list();
  CHECK(another.receive<usbip::DeviceListReply>().device_count == 1);
  configure(importer);
}

TEST_CASE("a client of another protocol is disconnected at its first byte") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  for (const char* begin : {"G", "\x16", "\x01G"}) {
    CAPTURE(begin);
    tests::PlainClient client(board.usb.address());
    client.send(begin);
    CHECK(client.is_closed());
  }
}

TEST_CASE(
    "over a Unix socket a client can import the device, and the board identifies the process for which it waits") {
  const tests::TemporaryDirectory directory;
  LiveBoard board({.path = directory / "usbip"});
  REQUIRE(board.wait_until_enumerated());
  tests::PlainClient client(board.usb.address());
  const auto send = [&](const auto& message) {
    const auto bytes = usbip::bytes_of(message);
    CHECK(client.send({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  };
  send(usbip::ImportRequest{.bus_id = {"1-1"}});
  std::array<std::byte, sizeof(usbip::OperationHeader) + sizeof(usbip::Device)> reply{};
  REQUIRE(::recv(client.descriptor(), reply.data(), reply.size(), MSG_WAITALL) == reply.size());
  CHECK(usbip::read<usbip::OperationHeader>(reply).status == OperationStatus::success);
  CHECK(virtual_board::client_name(virtual_board::peer_of(client.descriptor()))
            .ends_with("(process " + std::to_string(getpid()) + ")"));
}

TEST_CASE("a client that takes back more transfers than there can be is disconnected") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  UsbIpClient client(board.usb.port());
  REQUIRE(client.import() == OperationStatus::success);
  board.call([&] {  // no request is answered in the meantime
    for (std::uint32_t sequence = 1; sequence <= 5000; ++sequence) client.unlink(sequence, 0);
    CHECK(client.closed());
  });
  CHECK(board.wait_until_enumerated());
}

/// No further file can be opened while this object exists.
class NoMoreFiles {
 public:
  NoMoreFiles() {
    ::getrlimit(RLIMIT_NOFILE, &limit_);
    const rlimit lowest{3, limit_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &lowest);
  }
  ~NoMoreFiles() { ::setrlimit(RLIMIT_NOFILE, &limit_); }
  NoMoreFiles(const NoMoreFiles&) = delete;
  NoMoreFiles& operator=(const NoMoreFiles&) = delete;

 private:
  rlimit limit_{};
};

TEST_CASE("a client that cannot be accepted for want of files does not hold up the board, and is served later") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  tests::PlainClient first(board.usb.address());
  local::Descriptor next(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(board.usb.port());
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  {
    const NoMoreFiles no_more;
    REQUIRE(::connect(next.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    for (int i = 0; i < 3; ++i) board.call([&] { board.usb.settle(); });
  }
  const usbip::OperationHeader header{.operation = usbip::Operation::request_device_list};
  const auto request = usbip::bytes_of(header);
  REQUIRE(::send(next.number(), request.data(), request.size(), MSG_NOSIGNAL) == request.size());
  std::array<std::byte, sizeof(usbip::DeviceListReply)> reply{};
  CHECK(::recv(next.number(), reply.data(), reply.size(), MSG_WAITALL) == reply.size());
}

TEST_CASE("a busy port is reported in a sentence") {
  LiveBoard board;
  FakeScheduler scheduler;
  FakeInterrupts interrupts;
  FakeLog log;
  FakeChipState state;
  FakeTriggers triggers;
  const std::string message = tests::message_of<std::runtime_error>([&] {
    virtual_board::VirtualUsb second(
        {scheduler, interrupts, log, log, state, triggers}, board.usb.address(), 0.0, [] {}, [] { return false; });
  });
  CHECK(tests::contains(message, std::to_string(board.usb.port())));
  CHECK(tests::contains(message, "another program listens"));
}

}  // namespace
}  // namespace inkwell::virtual_usb_test
