// Tests hosts that pad reports. hidapi on Windows pads every written and read report to the longest report of its kind.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "protocol/report_table.hpp"

#include "tests/firmware/link/transaction.hpp"
#include "tests/firmware/usb/device_bench.hpp"

namespace inkwell {

using test::Bytes;
using test::bytes_of;
using test::claim_report;
using test::command;
using test::ControlResult;
using test::DeviceBench;
using test::done_result;
using test::Handshake;
using test::request;
using test::stall_result;

namespace {

using protocol::ReportId;
using protocol::ReportKind;

constexpr std::uint32_t claim = 7;
constexpr std::size_t longest_output = protocol::longest_report(ReportKind::output);
constexpr std::size_t longest_feature = protocol::longest_report(ReportKind::feature);

Bytes padded_to(std::size_t size, std::span<const std::byte> used) {
  Bytes padded(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(std::min(used.size(), size)));
  padded.resize(size, std::byte{0x5A});
  return padded;
}

/// Program 7 is the driver of this device.
struct PaddingBench : DeviceBench {
  PaddingBench() {
    configure();
    run(1);  // removes the stop of the bus reset
    last_command.reset();
    const auto report = claim_report(protocol::ClaimOperation::claim, claim);
    REQUIRE(set_report(3, report) == done_result);
    link.program.take_force();  // removes the empty request of the bus reset
    link.program.take_shapes();
  }

  ControlResult write(ReportKind kind, std::span<const std::byte> used, std::size_t size) {
    const auto value = static_cast<std::uint16_t>(static_cast<unsigned>(kind) << 8 | static_cast<unsigned>(used[0]));
    return control(request(0x21, 9, value, 0, static_cast<std::uint16_t>(size)), padded_to(size, used));
  }
};

/// Checks that a report has an effect only with the accepted lengths. `has_effect` returns whether the last write had
/// an effect, and prepares another value for the next write.
template <class HasEffect>
void check_lengths(PaddingBench& bench, ReportId id, ReportKind kind, std::span<const std::byte> used,
                   HasEffect has_effect) {
  const protocol::ReportInfo* row = protocol::find_report(kind, id);
  REQUIRE(row != nullptr);
  const std::size_t longest = protocol::longest_report(kind);
  for (const std::size_t size : {used.size(), used.size() + 1, row->bytes - 1, row->bytes, longest - 1, longest}) {
    if (size < used.size() || size > longest) continue;
    CAPTURE(size);
    CHECK(bench.write(kind, used, size) == done_result);
    CHECK(has_effect());
  }
  for (const std::size_t size : {std::size_t{1}, row->set_bytes_minimum - 1, longest + 1}) {
    CAPTURE(size);
    CHECK(bench.write(kind, used, size) == stall_result);
    CHECK_FALSE(has_effect());
  }
}

}  // namespace

TEST_CASE("padding: the longest reports have the declared sizes") {
  CHECK(longest_output == sizeof(protocol::LocalModelReport));
  CHECK(longest_feature == protocol::force_law_report_maximum);
  CHECK(usb::ControlEndpoint::receive_maximum == longest_feature);
}

TEST_CASE("padding: parameters") {
  PaddingBench bench;
  test::Transaction transaction{test::entry(protocol::Parameter::wall_stiffness_N_per_m, 100.0f)};
  transaction.report().claim = claim;
  check_lengths(bench, ReportId::parameters, ReportKind::feature, transaction.bytes(), [&] {
    bench.run(1);
    float& wanted = transaction.report().entries[0].value;
    return bench.link.parameters.values()[protocol::Parameter::wall_stiffness_N_per_m] ==
           std::exchange(wanted, wanted + 1);
  });
}

TEST_CASE("padding: shapes") {
  PaddingBench bench;
  protocol::ShapesReport shapes{};
  shapes.claim = claim;
  shapes.plane_count = 1;
  shapes.planes[0] = {{0, 0, 0}, {0, 0, 1}, {800.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f}};
  const auto used = bytes_of(shapes).first(protocol::shapes_report_size(1));
  check_lengths(bench, ReportId::shapes, ReportKind::feature, used, [&] {
    const control::Shapes* taken = bench.link.program.take_shapes();
    return taken != nullptr && taken->life_periods[0] != 0 && taken->life_periods[1] == 0;
  });
  // The device receives and refuses a report that is too short for its planes.
  shapes.ticket = 5;
  CHECK(bench.write(ReportKind::feature, used, used.size() - 1) == done_result);
  const auto results = bench.get_feature<protocol::RequestResultsReport>(ReportId::request_results);
  CHECK(results.entries[0].ticket == 5);
  CHECK(results.entries[0].result == protocol::RequestResult::malformed);
  CHECK(bench.link.program.take_shapes() == nullptr);
}

TEST_CASE("padding: requests for black-box rows") {
  PaddingBench bench;
  protocol::BlackBoxRequest wanted{.first_row = 3};
  check_lengths(bench, ReportId::black_box_rows, ReportKind::feature, bytes_of(wanted), [&] {
    const std::uint16_t row = wanted.first_row++;
    return bench.link.black_box.rows().first_row == row;
  });
}

TEST_CASE("padding: claims") {
  PaddingBench bench;
  auto report = claim_report(protocol::ClaimOperation::take_over, 100);
  check_lengths(bench, ReportId::driver, ReportKind::feature, bytes_of(report),
                [&] { return bench.link.driver.is_held_by(report.claim++); });
}

TEST_CASE("padding: forces, over endpoint 0 and over the interrupt endpoint") {
  PaddingBench bench;
  protocol::ForceReport force{};
  force.mode = protocol::ForceMode::beside_walls;
  force.interval_ms = 1;
  force.force_N[1] = 0.5f;
  force.claim = claim;
  const auto is_felt = [&] {
    const control::ForceTarget* target = bench.link.program.take_force();
    ++force.sequence;
    return target != nullptr && target->force_N.y == 0.5f;
  };
  check_lengths(bench, ReportId::force, ReportKind::output, bytes_of(force), is_felt);
  const auto offer = [&](std::size_t size) {
    REQUIRE(bench.port.out(1, padded_to(size, bytes_of(force))) == Handshake::ack);
    bench.device.poll();
    return is_felt();
  };
  for (const std::size_t size : {sizeof force, sizeof force + 1, longest_output}) {
    CAPTURE(size);
    CHECK(offer(size));
  }
  CHECK_FALSE(offer(sizeof force - 1));
}

TEST_CASE("padding: commands") {
  PaddingBench bench;
  const auto wanted = command(protocol::Command::clear_fault, 1, claim);
  check_lengths(bench, ReportId::command, ReportKind::output, bytes_of(wanted), [&] {
    bench.run(1);
    return std::exchange(bench.last_command, std::nullopt).has_value();
  });
}

TEST_CASE("padding: data beyond the buffer of endpoint 0 is discarded and does not change the memory after it") {
  PaddingBench bench;
  const auto report = claim_report(protocol::ClaimOperation::claim, claim);
  const auto before = bench.get_feature<protocol::InformationReport>(ReportId::information);
  constexpr std::size_t room = usb::ControlEndpoint::buffer_size;
  for (std::size_t size = room - 65; size <= room + 65; size += 13)
    CHECK(bench.write(ReportKind::feature, bytes_of(report), size) == done_result);
  const auto after = bench.get_feature<protocol::InformationReport>(ReportId::information);
  CHECK(std::memcmp(&before, &after, sizeof before) == 0);
}

TEST_CASE("padding: a feature report that is read is filled with zeros to its declared length, or to wLength") {
  DeviceBench bench;
  bench.configure();
  bench.run(1);
  for (const protocol::ReportInfo& row : protocol::report_table) {
    if (!row.can_be_read || row.kind != ReportKind::feature) continue;
    CAPTURE(static_cast<int>(row.id));
    const auto read = [&](std::size_t length) {
      return bench.get_report(3, static_cast<std::uint8_t>(row.id), static_cast<std::uint16_t>(length)).data;
    };
    const Bytes whole = read(row.bytes);
    REQUIRE(whole.size() == row.bytes);
    CHECK(whole[0] == static_cast<std::byte>(row.id));
    CHECK(read(longest_feature).size() == row.bytes);
    for (const std::size_t length : {std::size_t{1}, std::size_t{8}, row.bytes - 1})
      CHECK(read(length) == Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
  }
}

TEST_CASE("padding: zeros follow the end of the report for every requested length") {
  DeviceBench bench;
  bench.configure();
  const auto& law = control::installed_force_law;
  const std::size_t full_packets = law.report_size / 64 * 64;
  for (const std::size_t length :
       {law.report_size - 1, law.report_size, law.report_size + 1, full_packets, full_packets + 64, full_packets + 128,
        longest_feature - 1, longest_feature, longest_feature + 1}) {
    CAPTURE(length);
    const Bytes data = bench.get_report(3, 0x15, static_cast<std::uint16_t>(length)).data;
    REQUIRE(data.size() == std::min(length, longest_feature));
    const auto end = data.begin() + static_cast<std::ptrdiff_t>(std::min(length, law.report_size));
    CHECK(std::equal(data.begin(), end, law.report));
    CHECK(std::all_of(end, data.end(), [](std::byte value) { return value == std::byte{0}; }));
  }
}

}  // namespace inkwell
