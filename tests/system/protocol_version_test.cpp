// Companion and firmware refuse a different protocol version, and the arm does not move.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/transport.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;
using protocol::Parameter;

namespace {

constexpr std::uint16_t next_version = protocol::protocol_version + 1;

template <class Report>
Report feature(device::Transport& transport, protocol::ReportId id) {
  Report report{};
  report.report_id = id;
  REQUIRE(transport.get_feature(std::as_writable_bytes(std::span(&report, 1))) == sizeof report);
  return report;
}

}  // namespace

TEST_CASE("the companion refuses firmware with another version of the protocol, and leaves it alone") {
  device::VirtualBoardOptions options;
  options.elf = build_directory() + "/../board/next-protocol.elf";
  const device::VirtualBoard board(options);
  auto control = board.control();
  while (!board.find()) std::this_thread::sleep_for(10ms);
  REQUIRE(board.find().has_value());
  control.trace_start();

  const TemporaryDirectory directory;
  const std::string address = board.usbip().text();
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"info"},
                                             {"watch", "--seconds", "1"},
                                             {"parameters"},
                                             {"parameters", "set", "wall_stiffness_N_per_m=100"},
                                             {"parameters", "save", directory.file("parameters.toml")},
                                             {"record", directory.file("recording.h5"), "--seconds", "1"},
                                             {"experiment", "wall", "--out", directory.file("experiment")},
                                             {"check", "directions", "--yes"},
                                             {"tune", "current-loop", "--yes", "--apply"}}) {
    auto words = command;
    words.insert(words.end(), {"--usbip", address});
    const auto result = run_program("inkwell", words);
    INFO(command.front(), ": ", result.out, result.err);
    CHECK(result.exit_code == 1);
    for (const std::string& said : {"The device uses protocol version " + std::to_string(next_version),
                                    "this companion uses version " + std::to_string(protocol::protocol_version),
                                    std::string("Flash the firmware that belongs to this companion")})
      CHECK(result.err.find(said) != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(directory.file("parameters.toml")));
  CHECK_FALSE(std::filesystem::exists(directory.file("recording.h5")));

  // The board received no transaction, and no motor had current in any control period.
  const auto transport = device::open_transport(*board.find());
  CHECK(feature<protocol::TransactionReport>(*transport, protocol::ReportId::transaction).transactions == 0);
  control.trace_stop();
  double largest_A = 0;
  std::size_t rows = 0;
  for (;;) {
    const auto trace = control.trace_read(20'000);
    if (trace.row_count() == 0) break;
    rows += trace.row_count();
    const auto first = static_cast<std::size_t>(
        std::find(trace.columns.begin(), trace.columns.end(), "true_current_1_A") - trace.columns.begin());
    REQUIRE(first + 3 <= trace.columns.size());
    for (std::size_t row = 0; row < trace.row_count(); ++row)
      for (std::size_t i = 0; i < 3; ++i)
        largest_A = std::max(largest_A, std::abs(trace.values[row * trace.columns.size() + first + i]));
  }
  CHECK(rows > 1000);
  CHECK(largest_A < 0.02);
}

TEST_CASE("the firmware refuses a companion with another version of the protocol, and keeps its values") {
  BoardRig rig;
  rig.run_until([](const auto& pose) { return pose.state == protocol::State::ready; });
  const auto before = rig.device->parameters();
  const auto endpoint = rig.board.find();
  rig.device.reset();
  rig.control.resume();
  REQUIRE(endpoint.has_value());
  auto transport = device::open_transport(*endpoint);

  const auto transactions =
      feature<protocol::TransactionReport>(*transport, protocol::ReportId::transaction).transactions;
  protocol::ParametersReport changes{};
  changes.operation = protocol::ParameterOperation::set;
  changes.version = next_version;
  changes.count = 1;
  changes.entries[0] = {info(Parameter::wall_stiffness_N_per_m).id, 0, 123.0f};
  transport->set_feature(std::as_bytes(std::span(&changes, 1)).first(protocol::parameters_report_size(1)));
  protocol::TransactionReport transaction_report{};
  do {
    transaction_report = feature<protocol::TransactionReport>(*transport, protocol::ReportId::transaction);
  } while (transaction_report.transactions == transactions);
  CHECK(transaction_report.refusal == protocol::Refusal::wrong_version);
  CHECK(std::string(info(transaction_report.refusal).remedy).find("companion") != std::string::npos);

  // The board does not execute a command with the wrong protocol version.
  protocol::CommandReport enable{};
  enable.command = protocol::Command::enable_force;
  enable.version = static_cast<std::uint8_t>(next_version);
  enable.token = 77;
  transport->write_report(std::as_bytes(std::span(&enable, 1)));
  protocol::PoseReport pose{};
  for (int i = 0; i < 100; ++i) {
    REQUIRE(transport->read_report(std::as_writable_bytes(std::span(&pose, 1)), 2000ms) == sizeof pose);
    REQUIRE(pose.state == protocol::State::ready);
    REQUIRE(pose.command_token != enable.token);
  }
  CHECK(largest_current_A(rig.control) < 0.02);

  // The board accepts the same report with the right protocol version.
  enable.version = static_cast<std::uint8_t>(protocol::protocol_version);
  transport->write_report(std::as_bytes(std::span(&enable, 1)));
  for (int i = 0; i < 100 && !protocol::force_is_on(pose.state); ++i)
    REQUIRE(transport->read_report(std::as_writable_bytes(std::span(&pose, 1)), 2000ms) == sizeof pose);
  CHECK(protocol::force_is_on(pose.state));
  CHECK(pose.command_token == enable.token);

  transport.reset();
  CHECK(device::Device::open(*endpoint)->parameters() == before);
}
