// Tests several programs that use one virtual board at the same time.
#include <doctest/doctest.h>

#include <array>
#include <optional>

#include "tests/boards/virtual/usb/usbip_client.hpp"

namespace inkwell::virtual_usb_test {

using usbip::OperationStatus;

namespace {

constexpr std::int32_t busy = -16;
constexpr std::array<std::uint8_t, 8> set_configuration{0x00, 9, 5, 0, 0, 0, 0, 0};

struct Program : UsbIpClient {
  explicit Program(LiveBoard& board) : UsbIpClient(board.usb.port()) {
    REQUIRE(import() == OperationStatus::success);
    submit(1, 0, false, 0, {}, set_configuration);
    REQUIRE(read_reply().status == 0);
  }
  void ask_for_report(std::uint32_t sequence) { submit(sequence, 1, true, 64); }
  /// Returns the first byte of the report that answers the oldest request.
  int read_report() {
    const auto reply = read_reply();
    REQUIRE(reply.status == 0);
    const Bytes data = receive(reply.actual_length);
    REQUIRE(!data.empty());
    return std::to_integer<int>(data[0]);
  }
};

/// Returns after the board has received all earlier requests.
void settle(LiveBoard& board) {
  board.call([&] { board.usb.settle(); });
}

void send_report(LiveBoard& board, int first) {
  settle(board);
  board.call([&] { board.firmware.send_report(std::array{std::byte(first), std::byte{0}}); });
}

}  // namespace

TEST_CASE("each report reaches every program with a request, and only the first program resets the device") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  Program first(board);
  unsigned resets = 0;
  board.call([&] { resets = board.firmware.resets; });
  Program second(board), late(board);
  board.call([&] { CHECK(board.firmware.resets == resets); });
  first.ask_for_report(10);
  second.ask_for_report(10);
  for (int i = 0; i < 3; ++i) {
    send_report(board, 50 + i);
    for (Program* program : {&first, &second}) {
      CHECK(program->read_report() == 50 + i);
      program->ask_for_report(static_cast<std::uint32_t>(11 + i));
    }
  }
  // A program without a pending request misses earlier reports and receives the next report.
  late.ask_for_report(10);
  send_report(board, 60);
  CHECK(late.read_report() == 60);
  board.call([&] { CHECK(board.log.sentences.empty()); });
}

TEST_CASE("each program has separate transfer numbers, and an unlinked request affects no other program") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  Program first(board), second(board);
  first.ask_for_report(7);
  second.ask_for_report(7);
  first.unlink(8, 7);
  CHECK(first.receive<usbip::ReturnUnlink>().status == -104);
  send_report(board, 33);
  CHECK(second.read_report() == 33);
  // A report without a request waits for the next request.
  second.ask_for_report(9);
  second.unlink(10, 9);
  CHECK(second.receive<usbip::ReturnUnlink>().status == -104);
  send_report(board, 34);
  first.ask_for_report(11);
  CHECK(first.read_report() == 34);
  // Control transfers of both programs are completed.
  constexpr std::array<std::uint8_t, 8> get_device_descriptor{0x80, 6, 0, 1, 0, 0, 18, 0};
  for (Program* program : {&first, &second}) {
    program->submit(20, 0, true, 18, {}, get_device_descriptor);
    const auto reply = program->read_reply();
    CHECK(reply.header.sequence == 20);
    CHECK(program->receive(reply.actual_length).size() == 18);
  }
}

TEST_CASE(
    "the stream belongs to the first program that requests it, until this program unlinks its requests or exits") {
  LiveBoard board;
  board.firmware.stream(true);
  REQUIRE(board.wait_until_enumerated());
  std::optional<Program> first(std::in_place, board);
  Program second(board);
  first->submit(30, 2, true, 64);
  CHECK(first->receive(first->read_reply().actual_length).size() == 64);
  board.pause(true);
  first->submit(31, 2, true, 64);
  settle(board);
  second.submit(30, 2, true, 64);
  settle(board);
  CHECK(second.read_reply().status == busy);
  SUBCASE("taken back") {
    first->unlink(32, 31);
    settle(board);
    CHECK(first->receive<usbip::ReturnUnlink>().status == -104);
  }
  SUBCASE("gone") {
    first.reset();
    settle(board);
  }
  board.pause(false);
  second.submit(33, 2, true, 64);
  const auto reply = second.read_reply();
  CHECK(reply.status == 0);
  CHECK(second.receive(reply.actual_length).size() == 64);
}

TEST_CASE("the exit of a program does not affect other programs, and the exit of the last program silences the bus") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  unsigned resets = 0;
  {
    std::optional<Program> first(std::in_place, board);
    Program second(board);
    board.call([&] { resets = board.firmware.resets; });
    first->ask_for_report(40);
    second.ask_for_report(40);
    first.reset();
    settle(board);
    send_report(board, 70);
    CHECK(second.read_report() == 70);
    board.call([&] {
      CHECK(board.firmware.resets == resets);
      CHECK(board.firmware.configuration == 5);
      CHECK(board.usb.imported());
    });
  }
  REQUIRE(board.wait_until_enumerated());
  board.call([&] { CHECK(!board.usb.imported()); });
  Program next(board);
  board.call([&] { CHECK(board.firmware.resets == resets + 1); });
}

TEST_CASE(
    "the board waits for a program that accepts no reports, but not indefinitely while other programs request "
    "reports") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  Program stopped(board), other(board);
  for (std::uint32_t sequence = 60; sequence < 62; ++sequence) stopped.ask_for_report(sequence);
  for (std::uint32_t sequence = 60; sequence < 63; ++sequence) other.ask_for_report(sequence);
  for (int i = 0; i < 3; ++i) send_report(board, 90 + i);
  for (int i = 0; i < 3; ++i) CHECK(other.read_report() == 90 + i);
  other.ask_for_report(63);
  send_report(board, 93);
  CHECK(other.read_report() == 93);
  for (int i = 0; i < 2; ++i) CHECK(stopped.read_report() == 90 + i);  // the program missed the later reports
  stopped.ask_for_report(62);
  other.ask_for_report(64);
  send_report(board, 94);
  CHECK(stopped.read_report() == 94);
}

TEST_CASE("unplugging the device disconnects all programs, and all programs can connect again") {
  LiveBoard board;
  REQUIRE(board.wait_until_enumerated());
  {
    Program first(board), second(board);
    first.ask_for_report(50);
    board.call([&] { board.usb.disconnect(); });
    CHECK(first.closed());
    CHECK(second.closed());
  }
  board.call([&] { board.usb.connect(); });
  REQUIRE(board.wait_until_enumerated());
  Program first(board), second(board);
  first.ask_for_report(50);
  second.ask_for_report(50);
  send_report(board, 80);
  CHECK(first.read_report() == 80);
  CHECK(second.read_report() == 80);
}

}  // namespace inkwell::virtual_usb_test
