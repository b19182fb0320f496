// Tests the device library with a USB/IP server: identity, poses, commands, parameters, scope, and every possible
// failure of the server.
#include <doctest/doctest.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <future>
#include <limits>
#include <thread>

#include "host/client/device/device.hpp"
#include "protocol/usbip/messages.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Parameter;

namespace {

protocol::PoseReport pose_number(std::uint32_t sequence) {
  protocol::PoseReport pose{};
  pose.report_id = protocol::ReportId::pose;
  pose.state = protocol::State::ready;
  pose.sequence = sequence;
  pose.time_periods = 20 * sequence;
  pose.position_m[2] = 0.125f;
  return pose;
}

}  // namespace

TEST_CASE("arms at a USB/IP server are found, and other devices are ignored") {
  FakeUsbipServer server;
  const auto found = device::find_usbip_devices({"127.0.0.1", server.port()});
  REQUIRE(found.size() == 1);
  CHECK(found[0].path == "1-1");
  CHECK_FALSE(found[0].is_virtual);
  SUBCASE("another product") { server.product_id = 0x0BAD; }
  SUBCASE("another vendor") { server.vendor_id = 0x0BAD; }
  CHECK(device::find_usbip_devices({"127.0.0.1", server.port()}).empty());
}

TEST_CASE("a server may export several arms") {
  FakeUsbipServer server;
  server.spoil_reply = [](Bytes& reply) {
    constexpr std::size_t count_at = 11, device_at = 12;
    const Bytes device(reply.begin() + device_at, reply.end());
    reply.insert(reply.end(), device.begin(), device.end());
    reply[count_at] = std::byte{2};
  };
  const auto found = device::find_usbip_devices({"127.0.0.1", server.port()});
  REQUIRE(found.size() == 2);
  CHECK(found[1].path == "1-1");
}

TEST_CASE("the device path at a server identifies a virtual board") {
  FakeUsbipServer server;
  server.path = "/inkwell_virtual_board/usb1/1-1";
  const auto found = device::find_usbip_devices({"127.0.0.1", server.port()});
  REQUIRE(found.size() == 1);
  CHECK(found[0].is_virtual);
}

TEST_CASE("an arm on USB/IP reports its identity and streams its pose") {
  FakeUsbipServer server;
  server.information.firmware_version[1] = 3;
  const auto arm = device::Device::open(server.endpoint());
  const auto information = arm->information();
  CHECK(information.firmware_version == "0.3.0");
  CHECK(information.serial_number == "0123456789ABCDEF01234567");
  CHECK(information.force_law->name == "box");
  CHECK_FALSE(arm->read_pose(1ms));
  server.send(1, Bytes(5, std::byte{1}));  // not a pose, so it is ignored
  server.send(1, Bytes(sizeof(protocol::PoseReport), std::byte{2}));
  server.send(1, {});
  for (std::uint32_t i = 0; i < 100; ++i) server.send(1, bytes_of(pose_number(i)));
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto pose = arm->read_pose(60s);
    REQUIRE(pose);
    CHECK(pose->sequence == i);
    CHECK(pose->position_m[2] == 0.125f);
  }
}

TEST_CASE("enough pose transfers are pending for a slow reader, and scope transfers are pending after a selection") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(eventually([&] { return server.waiting_transfers(1) >= 16; }));
  CHECK(server.waiting_transfers(2) == 0);
  arm->select_signals({});
  arm->information();
  CHECK(server.waiting_transfers(2) == 0);
  for (int i = 0; i < 2; ++i) arm->select_signals(std::vector{protocol::Signal::force_N});
  CHECK(eventually([&] { return server.waiting_transfers(2) >= 20; }));  // 20 frames of 6 KiB cover 100 ms
  arm->information();
  CHECK(server.waiting_transfers(2) == 21);
}

TEST_CASE("a reader that pauses for one second loses the oldest poses, and the stored amount is limited") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  constexpr std::uint32_t kept = 1024, lost = 76, under_way = 32;
  for (std::uint32_t i = 0; i < kept + lost; ++i) server.send(1, bytes_of(pose_number(i)));
  REQUIRE(eventually([&] { return server.waiting_transfers(1) == under_way; }));
  for (std::uint32_t i = lost; i < kept + lost; ++i) {
    const auto pose = arm->read_pose(60s);
    REQUIRE(pose);
    CHECK(pose->sequence == i);
  }
}

TEST_CASE("more signals than the scope carries are refused before anything is sent") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  std::vector<protocol::Signal> signals(protocol::scope_signals_maximum, protocol::Signal::force_N);
  arm->select_signals(signals);
  signals.push_back(protocol::Signal::force_N);
  CHECK(contains(message_of<device::Error>([&] { arm->select_signals(signals); }),
                 "cannot transmit 33 signals that contain a signal twice"));
  arm->send(protocol::Command::heartbeat);
  CHECK(eventually([&] { return server.commands().size() == 2; }));
}

TEST_CASE("a scope that another program has costs only the scope, until it is free") {
  FakeUsbipServer server;
  server.scope_is_taken = true;
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<protocol::Signal> signals{protocol::Signal::force_N};
  CHECK(contains(message_of<device::InUse>([&] { arm->select_signals(signals); }), "other program"));
  arm->select_signals({});
  CHECK(arm->information().serial_number == "0123456789ABCDEF01234567");
  server.scope_is_taken = false;
  const auto token = arm->select_signals(signals);
  server.send(2, scope_frame(token, 5, 2.5f));
  CHECK(arm->read_scope(60s)->first_period == 5);
}

TEST_CASE("a device that accepts no more commands causes an error, and no further commands are sent to it") {
  FakeUsbipServer server;
  server.holds_outputs = true;
  const auto arm = device::Device::open(server.endpoint());
  constexpr std::size_t under_way = 16;
  for (std::size_t i = 0; i < under_way; ++i) arm->send(protocol::Command::heartbeat);
  SUBCASE("and sends nothing either") {
    const auto message = message_of<device::Error>([&] { arm->send(protocol::Command::heartbeat); });
    CHECK(contains(message, "accepts no commands and is silent"));
  }
  SUBCASE("while it sends its pose for a second of its time") {
    for (int i = 0; i < 1000; ++i) server.send(1, Bytes(sizeof(protocol::PoseReport), std::byte{2}));
    const auto message = message_of<device::Error>([&] { arm->send(protocol::Command::heartbeat); });
    CHECK(contains(message, "accepts no commands, although it sends poses"));
  }
  arm->information();
  CHECK(server.commands().size() == under_way);
}

TEST_CASE(
    "wait_until_written waits until the device accepts everything, or accepts nothing for one second of device time") {
  FakeUsbipServer server;
  server.holds_outputs = true;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(arm->wait_until_written(0ms));
  for (int i = 0; i < 2; ++i) arm->send(protocol::Command::heartbeat);
  arm->information();  // requests and answers arrive in order
  server.answer_output();
  arm->information();
  CHECK_FALSE(arm->wait_until_written(0ms));
  SUBCASE("it accepts the rest") {
    server.answer_output();
    CHECK(arm->wait_until_written(60s));
  }
  SUBCASE("it accepts nothing") {
    for (int i = 0; i < 1000; ++i) server.send(1, Bytes(sizeof(protocol::PoseReport), std::byte{2}));
    const auto message = message_of<device::Error>([&] { arm->wait_until_written(60s); });
    CHECK(contains(message, "accepts no commands, although it sends poses"));
  }
  SUBCASE("the device is disconnected") {
    server.hang_up();
    CHECK_THROWS_AS(arm->wait_until_written(60s), device::Disconnected);
  }
}

TEST_CASE("how long a device takes no command counts from the one that it took last") {
  FakeUsbipServer server;
  server.holds_outputs = true;
  const auto arm = device::Device::open(server.endpoint());
  std::uint32_t sequence = 0;
  const auto pass = [&](std::uint32_t poses) {
    const std::uint32_t end = sequence + poses;
    while (sequence < end) server.send(1, bytes_of(pose_number(sequence++)));
    REQUIRE(eventually([&] {
      const auto pose = arm->read_pose(1s);
      return pose && pose->sequence + 1 == end;
    }));
  };
  const auto send_the_next = [&] {
    auto sent = std::async(std::launch::async, [&] { arm->send(protocol::Command::heartbeat); });
    CHECK(sent.wait_for(100ms) == std::future_status::timeout);  // the call blocks until the queue has room
    server.answer_output();
    CHECK_NOTHROW(sent.get());
  };
  pass(1000);  // one second without a command
  for (int i = 0; i < 16; ++i) arm->send(protocol::Command::heartbeat);
  send_the_next();
  for (int i = 0; i < 2; ++i) {
    pass(600);
    send_the_next();
  }
}

TEST_CASE("a lost device raises Disconnected for any transfer that fails") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  arm->select_signals(std::vector{protocol::Signal::force_N});
  REQUIRE(eventually([&] { return server.waiting_transfers(1) > 0 && server.waiting_transfers(2) > 0; }));
  SUBCASE("of a pose") { server.fail(1, -ENODEV); }
  SUBCASE("of the scope") { server.fail(2, -ENODEV); }
  SUBCASE("of a command") {
    server.output_status = -ENODEV;
    CHECK(eventually([&] {
      try {
        arm->send(protocol::Command::heartbeat);
        return false;
      } catch (const device::Disconnected&) {
        return true;
      }
    }));
    return;
  }
  CHECK_THROWS_AS(arm->read_pose(60s), device::Disconnected);
  CHECK_THROWS_AS(arm->read_scope(60s), device::Disconnected);
}

TEST_CASE("a pending request of a broken connection raises Disconnected") {
  FakeUsbipServer server;
  server.transactions_to_break_at = 1;
  const auto arm = device::Device::open(server.endpoint());
  CHECK_THROWS_AS(arm->place_shapes({}), device::Disconnected);
}

TEST_CASE("a server that breaks the rules of USB/IP is left with a sentence") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  std::string words;
  SUBCASE("more data than there is room for") {
    server.send(1, Bytes(sizeof(protocol::PoseReport) + 1));
    words = "was not requested";
  }
  SUBCASE("an answer to nothing") {
    usbip::ReturnSubmit answer{.status = 0};
    answer.header.sequence = 0xFFFF;
    server.send_unasked(bytes_of(answer));
    words = "was not requested";
  }
  SUBCASE("no answer at all") {
    server.send_unasked(bytes_of(usbip::Submit{}));
    words = "an invalid message";
  }
  SUBCASE("an end") {
    server.hang_up();
    words = "The arm at 127.0.0.1:" + std::to_string(server.port()) + " was disconnected";
  }
  CHECK(contains(message_of<device::Disconnected>([&] { arm->read_pose(60s); }), words));
}

TEST_CASE("a server that does not use USB/IP 1.1.1 causes an error") {
  FakeUsbipServer server;
  std::size_t at = 0;
  SUBCASE("another version") { at = 1; }
  SUBCASE("a reply to something else") { at = 3; }
  server.spoil_reply = [=](Bytes& reply) { reply[at] ^= std::byte{0x40}; };
  const auto list = [&] { device::find_usbip_devices({"127.0.0.1", server.port()}); };
  CHECK(contains(message_of<device::Error>(list), "does not use USB/IP"));
  CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "does not use USB/IP"));
}

TEST_CASE("a server that lists more devices than there can be is not listened to") {
  FakeUsbipServer server;
  server.spoil_reply = [](Bytes& reply) {
    constexpr std::size_t count_at = 8;  // after the header
    for (std::size_t i = 0; i < 4; ++i) reply[count_at + i] = std::byte{0xFF};
    reply.resize(count_at + 4);
  };
  const auto message = message_of<device::Error>([&] { device::find_usbip_devices(server.endpoint().server); });
  CHECK(contains(message, "lists 4294967295 devices"));
}

TEST_CASE("one program uses one force law at a time, and the error names the law in use") {
  const auto report_of = [](const std::string& name) {  // one parameter without unit and help text
    Bytes report{std::byte{0x15}, std::byte{1}, {}, {}, {}, {}};
    const auto text = [&](const std::string& characters) {
      for (const char c : characters + '\0') report.push_back(static_cast<std::byte>(c));
    };
    text(name);
    text("");
    report.resize(report.size() + 3 * sizeof(float));
    for (const char* column : {"gain", "", ""}) text(column);
    report[4] = static_cast<std::byte>(report.size());
    return report;
  };
  FakeUsbipServer server, other;
  server.spoil[protocol::ReportId::force_law] = [&](Bytes& report) { report = report_of("spring"); };
  other.spoil[protocol::ReportId::force_law] = [&](Bytes& report) { report = report_of("magnet"); };
  auto arm = device::Device::open(server.endpoint());
  CHECK(arm->information().force_law->name == "spring");
  CHECK_THROWS_AS(arm->parameters(), device::Incompatible);  // the server sends the parameters of the table only
  const auto message = message_of<device::Error>([&] { device::Device::open(other.endpoint()); });
  CHECK(contains(message, "force law magnet, but this program already uses the force law spring"));
  arm.reset();
  CHECK_NOTHROW(device::Device::open(other.endpoint()));
  FakeUsbipServer without_rows;
  CHECK_NOTHROW(device::Device::open(without_rows.endpoint()));  // the tables are restored
}

TEST_CASE("commands carry version and a token that is never 0") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  for (int i = 0; i < 300; ++i) CHECK(arm->send(protocol::Command::heartbeat) != 0);
  arm->send(protocol::Command::test_current, {2, 0.5f, 0.04f});
  REQUIRE(eventually([&] { return server.commands().size() == 301; }));
  const auto commands = server.commands();
  CHECK(commands[0].version == protocol::protocol_version);
  CHECK(commands[0].token != commands[1].token);
  CHECK(commands[300].command == protocol::Command::test_current);
  CHECK(commands[300].test.motor == 2);
  CHECK(float{commands[300].test.amplitude} == 0.5f);  // a copy, because the member may be unaligned in the report
}

TEST_CASE("a heartbeat is sent 200 control periods after the last command, and not earlier") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  const auto commands_sent = [&] {  // commands arrive in order, so the count is complete once this command has arrived
    const auto token = arm->send(protocol::Command::clear_fault);
    REQUIRE(eventually([&] { return !server.commands().empty() && server.commands().back().token == token; }));
    return server.commands().size();
  };
  std::uint32_t time_periods = 0;
  const auto heartbeats_after = [&](std::uint32_t periods) {
    const std::size_t before = commands_sent();
    auto pose = pose_number(1);
    pose.time_periods = time_periods += periods;
    server.send(1, bytes_of(pose));
    REQUIRE(arm->read_pose(60s));
    for (int i = 0; i < 3; ++i) arm->keep_alive();
    return commands_sent() - before - 1;
  };
  CHECK(heartbeats_after(199) == 0);
  std::this_thread::sleep_for(20ms);
  CHECK(heartbeats_after(0) == 0);  // board time does not advance
  CHECK(heartbeats_after(200) == 1);
  CHECK(heartbeats_after(20'000) == 1);
}

TEST_CASE("poses, frames, samples and transactions are on one time that does not wrap with the board's counters") {
  constexpr std::int64_t wrap = std::int64_t{1} << 32;
  FakeUsbipServer server;
  server.bus_frame.sequence = 0xFFFF'FFFF;
  server.bus_frame.time_periods = 0xFFFF'FFF0;
  const auto arm = device::Device::open(server.endpoint());
  auto report = pose_number(3);
  report.time_periods = 60;
  server.send(1, bytes_of(report));
  const auto pose = arm->read_pose(60s);
  REQUIRE(pose);
  CHECK(pose->sequence == wrap + 3);
  CHECK(pose->time_periods == wrap + 60);
  server.bus_frame.sequence = 4;
  server.bus_frame.time_periods = 80;
  CHECK(arm->bus_frame().value().sequence == wrap + 4);
  CHECK(arm->bus_frame().value().time_periods == wrap + 80);
  server.send(2, scope_frame(arm->select_signals(std::array{protocol::Signal::force_N}), 90, 0.5f));
  CHECK(arm->read_scope(60s)->first_period == wrap + 90);
  const device::ParameterChange change{protocol::Parameter::force_limit_N, 1.0f};
  CHECK(arm->set_parameters({&change, 1}).applied_at_periods == wrap + 100);  // the first time that this server returns
}

TEST_CASE("bus_frame returns the newest bus frame with its start time in device cycles") {
  FakeUsbipServer server;
  server.bus_frame.sequence = 12;
  server.bus_frame.time_cycles = 345;
  const auto arm = device::Device::open(server.endpoint());
  CHECK(arm->bus_frame().value().sequence == 12);
  CHECK(arm->bus_frame().value().time_cycles == 345);
}

TEST_CASE("a device names its board, also where it is refused") {
  FakeUsbipServer server;
  std::ranges::copy(std::string_view("feather"), server.information.board);
  const auto board_of_refused = [&] {
    try {
      device::Device::open(server.endpoint());
    } catch (const device::Incompatible& error) {
      return error.board_name;
    }
    return std::string("not refused");
  };
  SUBCASE("of this version") {
    CHECK(device::Device::open(server.endpoint())->information().board_name == "feather");
    server.information.board[0] = '\n';
    CHECK(device::Device::open(server.endpoint())->information().board_name.empty());
  }
  SUBCASE("of the next version") {
    ++server.information.version;
    CHECK(board_of_refused() == "feather");
    server.spoil[protocol::ReportId::information] = [](Bytes& report) {
      report.resize(offsetof(protocol::InformationReport, parameter_table_hash) + 4);
    };
    CHECK(board_of_refused() == "feather");
    server.spoil[protocol::ReportId::information] = [](Bytes& report) {
      report.resize(offsetof(protocol::InformationReport, parameter_table_hash) - 1);
    };
    CHECK(board_of_refused().empty());
  }
  SUBCASE("of other tables") {
    server.information.signal_table_hash ^= 1u;
    CHECK(board_of_refused() == "feather");
  }
  SUBCASE("of a version that named none, whose report was shorter") {
    server.information.version = protocol::first_version_with_board - 1;
    server.information.firmware_version[1] = 7;
    server.spoil[protocol::ReportId::information] = [](Bytes& report) { report.resize(72); };
    CHECK(board_of_refused().empty());
    const auto information = device::Device(device::open_transport(server.endpoint())).information();
    CHECK(information.firmware_version == "0.7.0");
    CHECK(information.protocol_version == 11);
    CHECK(information.report.servo_rate_Hz == 0);  // the field has another meaning in this version
  }
}

TEST_CASE("firmware of another protocol version is refused with the remedy") {
  FakeUsbipServer server;
  SUBCASE("version") {
    server.information.version = protocol::protocol_version + 1;
    const auto message = message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); });
    const std::string asked = "version " + std::to_string(protocol::protocol_version);
    CHECK(contains(message, asked.c_str()));
    CHECK(contains(message, "Flash"));
  }
  SUBCASE("tables") {
    SUBCASE("of parameters") { server.information.parameter_table_hash ^= 1u; }
    SUBCASE("of signals") { server.information.signal_table_hash ^= 1u; }
    CHECK(contains(message_of<device::Incompatible>([&] { device::Device::open(server.endpoint()); }), "parameters"));
  }
}

TEST_CASE("scope frames arrive decoded; empty transfers between them are nothing") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  const std::vector<protocol::Signal> signals{protocol::Signal::force_N};
  const auto token = arm->select_signals(signals);
  server.send(2, {});
  server.send(2, Bytes(64, std::byte{0xAA}));  // may be the rest of a frame that another program began to read
  server.send(2, Bytes(64, std::byte{0xAA}));
  server.send(2, scope_frame(token, 77, 2.5f));
  const auto samples = arm->read_scope(60s);
  REQUIRE(samples);
  CHECK(samples->first_period == 77);
  CHECK(samples->values == std::vector<float>{2.5f});
  CHECK(arm->malformed_scope_frames() == 1);
  CHECK_FALSE(arm->read_scope(1ms));
}

TEST_CASE("a transport has the product name and serial number of its device") {
  FakeUsbipServer server;
  const auto transport = device::open_transport(server.endpoint());
  CHECK(transport->endpoint().product == "Inkwell haptic arm");
  CHECK(transport->endpoint().serial_number == "0123456789ABCDEF01234567");
}

TEST_CASE("if the reader stops reading the scope, the transport unlinks a transfer") {
  FakeUsbipServer server;
  const auto transport = device::open_transport(server.endpoint());
  transport->claim_scope();
  constexpr std::size_t kept = 682, under_way = 21;
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  for (std::size_t i = 0; i + 1 < kept; ++i) server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  CHECK(server.transfers_taken_back() == 0);
  server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way - 2; }));
  CHECK(server.transfers_taken_back() == 1);
  for (std::size_t i = 0; i < under_way - 2; ++i) server.send(2, Bytes(4));  // these transfers still count
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == 0; }));
  Bytes information(sizeof(protocol::InformationReport), static_cast<std::byte>(protocol::ReportId::information));
  transport->get_feature(information);  // earlier answers have arrived; only reading makes room
  Bytes transfer(64);
  for (std::size_t i = 0; i < kept + under_way - 2; ++i) REQUIRE(transport->read_bulk(transfer, 60s) == 4);
  CHECK(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  CHECK(server.transfers_taken_back() == 1);
}

TEST_CASE("an empty signal selection releases the scope, and a new selection claims it again") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  constexpr std::size_t under_way = 21;
  const std::vector<protocol::Signal> signals{protocol::Signal::force_N};
  arm->select_signals(signals);
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == under_way; }));
  arm->select_signals({});
  CHECK(server.waiting_transfers(2) == 0);
  CHECK(server.transfers_taken_back() == under_way);
  server.send(2, scope_frame(1, 1, 1.0f));
  const auto token = arm->select_signals(signals);
  server.send(2, scope_frame(token, 5, 2.5f));
  CHECK(arm->read_scope(60s)->first_period == 5);
  CHECK(eventually([&] { return server.waiting_transfers(2) == under_way; }));
}

TEST_CASE("an unlinked transfer releases the scope, even if all transfers have ended") {
  FakeUsbipServer server;
  const auto transport = device::open_transport(server.endpoint());
  transport->release_scope();  // has no effect, because the scope is not claimed
  transport->claim_scope();
  constexpr std::size_t kept = 682, under_way = 21;
  for (std::size_t i = 0; i < kept; ++i) server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.transfers_taken_back() == 1; }));
  for (std::size_t i = 0; i < under_way - 2; ++i) server.send(2, Bytes(4));
  REQUIRE(eventually([&] { return server.waiting_transfers(2) == 0; }));
  Bytes information(sizeof(protocol::InformationReport), static_cast<std::byte>(protocol::ReportId::information));
  transport->get_feature(information);  // earlier answers have arrived
  transport->release_scope();
  CHECK(server.transfers_taken_back() == 2);
  CHECK(server.waiting_transfers(2) == 0);
  server.hang_up();
  transport->release_scope();
}

TEST_CASE("every call raises Disconnected after the connection breaks") {
  FakeUsbipServer server;
  const auto arm = device::Device::open(server.endpoint());
  server.send(1, bytes_of(pose_number(1)));
  REQUIRE(arm->read_pose(60s));
  server.hang_up();
  CHECK_THROWS_AS(arm->read_pose(60s), device::Disconnected);
  CHECK_THROWS_AS(arm->read_scope(60s), device::Disconnected);
  CHECK_THROWS_AS(arm->information(), device::Disconnected);
  CHECK_THROWS_AS(arm->send(protocol::Command::heartbeat), device::Disconnected);
}

TEST_CASE("with a seed the claim and the tickets are the same each time, without one they are random") {
  const auto numbers_with = [](std::optional<std::uint64_t> seed) {
    FakeUsbipServer server;
    auto endpoint = server.endpoint();
    endpoint.seed = seed;
    const auto arm = device::Device::open(endpoint);
    arm->claim();
    arm->stop();
    const auto command = server.commands().back();
    return std::pair(std::uint32_t{command.claim}, std::uint32_t{command.ticket});
  };
  CHECK(numbers_with(7) == numbers_with(7));
  CHECK(numbers_with(7) != numbers_with(8));
  CHECK(numbers_with(std::nullopt) != numbers_with(std::nullopt));
}

TEST_CASE("a device continues on another link, and calls that wait on the old one end") {
  FakeUsbipServer before, after;
  after.parameters[Parameter::wall_stiffness_N_per_m] = 321.0f;
  const auto arm = device::Device::open(before.endpoint());
  arm->select_signals(std::vector{protocol::Signal::force_N});
  before.holds_requests = true;
  auto waits =
      std::async(std::launch::async, [&] { return message_of<device::Disconnected>([&] { arm->bus_frame(); }); });
  before.hang_up();
  CHECK(waits.get() != "");
  arm->take_link_of(*device::Device::open(after.endpoint()));
  after.send(1, bytes_of(pose_number(7)));
  const auto pose = arm->read_pose(60s);
  REQUIRE(pose);
  CHECK(pose->sequence == 7);
  CHECK(arm->parameters()[Parameter::wall_stiffness_N_per_m] == 321.0f);
  arm->keep_alive();
  arm->send_force({.force_N = {1.0f, 0.0f, 0.0f}});
  CHECK(eventually([&] { return after.commands().size() == 1 && after.forces().size() == 1; }));
  const auto token = arm->select_signals(std::vector{protocol::Signal::force_N});
  after.send(2, scope_frame(token, 3, 0.5f));
  const auto samples = arm->read_scope(60s);
  REQUIRE(samples);
  CHECK(samples->lost_before == 0);
}

TEST_CASE("a device that is in use, damaged or absent is refused") {
  FakeUsbipServer server;
  SUBCASE("in use") {
    server.refuses_import = true;
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "another program"));
  }
  SUBCASE("without a scope") {
    server.configuration.resize(41);
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "scope"));
  }
  SUBCASE("damaged descriptor") {
    server.configuration[9] = std::byte{0};
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "damaged"));
  }
  SUBCASE("damaged descriptor of the device") {
    server.device_descriptor.pop_back();
    CHECK(contains(message_of<device::Error>([&] { device::Device::open(server.endpoint()); }), "damaged"));
  }
  SUBCASE("no program answers at the port") {
    CHECK(contains(message_of<device::Error>([] {
                     device::find_usbip_devices({"127.0.0.1", 1});
                   }),
                   "No program answers"));
  }
  SUBCASE("the host name is invalid") {
    CHECK(contains(message_of<device::Error>([] {
                     device::find_usbip_devices({"not a name", 1});
                   }),
                   "not a name is not"));
  }
}

TEST_CASE("a server without answers causes an error, and a device without poses does not") {
  FakeUsbipServer silent, quiet;
  silent.silent = true;
  const auto arm = device::Device::open(quiet.endpoint());
  const auto address = std::to_string(silent.port());
  const auto message = message_of<device::Error>([&] { device::find_usbip_devices({"127.0.0.1", silent.port()}); });
  CHECK(contains(message, "does not answer"));
  CHECK(contains(message, address.c_str()));
  CHECK_NOTHROW(arm->information());
}
