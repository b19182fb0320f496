// Tests reading the black box of a device, with other readers and changing contents.
#include <doctest/doctest.h>

#include <cstring>
#include <memory>

#include "host/client/device/device.hpp"
#include "tests/failure.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::BlackBoxReport;
using protocol::BlackBoxRequest;
using protocol::BlackBoxRowsReport;
using protocol::ReportId;

namespace {

/// Content of a device's black box, and the behavior of the device.
struct Kept {
  BlackBoxReport head{};
  int requests = 0;
  int asked_between = 0;  ///< number of requests of another program for other rows before each answer
  protocol::RequestResult result = protocol::RequestResult::accepted;
  std::size_t gone_from = ~0u;  ///< the row at which another black box replaces this black box
};

class KeepingTransport final : public device::Transport {
 public:
  explicit KeepingTransport(Kept& kept) : kept_(kept) {}

  std::size_t get_feature(std::span<std::byte> report) override {
    if (report[0] == static_cast<std::byte>(ReportId::black_box)) return give(report, kept_.head);
    REQUIRE(report[0] == static_cast<std::byte>(ReportId::black_box_rows));
    BlackBoxRowsReport rows{};
    rows.first_row = first_row_;
    rows.result = static_cast<std::uint8_t>(kept_.result) & 0xFu;
    rows.fault_periods = kept_.head.fault_periods;
    if (others_ > 0) {
      --others_;
      rows.first_row = static_cast<std::uint16_t>(first_row_ + 1);
    }
    if (first_row_ >= kept_.gone_from) rows.fault_periods += 1;
    for (std::size_t i = rows.first_row; i < kept_.head.row_count && rows.row_count < std::size(rows.rows); ++i) {
      rows.rows[rows.row_count] = {.time_periods = static_cast<std::uint32_t>(1000 + 20 * i), .values = {0.5f}};
      rows.row_count = (rows.row_count + 1u) & 0xFu;
    }
    return give(report, rows);
  }
  void set_feature(std::span<const std::byte> report) override {
    BlackBoxRequest request;
    REQUIRE(report.size() == sizeof request);
    std::memcpy(&request, report.data(), sizeof request);
    CHECK(request.report_id == ReportId::black_box_rows);
    CHECK(request.version == protocol::protocol_version);
    if (request.first_row != first_row_ || kept_.requests == 0) others_ = kept_.asked_between;
    first_row_ = request.first_row;
    ++kept_.requests;
  }
  std::size_t read_report(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  void write_report(std::span<const std::byte>) override {}
  void claim_scope() override {}
  void release_scope() override {}
  std::size_t read_bulk(std::span<std::byte>, std::chrono::milliseconds) override { return 0; }
  const device::Endpoint& endpoint() const override { return endpoint_; }

 private:
  template <class Report>
  static std::size_t give(std::span<std::byte> to, const Report& report) {
    std::memcpy(to.data(), &report, std::min(to.size(), sizeof report));
    return sizeof report;
  }

  Kept& kept_;
  std::uint16_t first_row_ = 0;
  int others_ = 0;
  device::Endpoint endpoint_;
};

Kept full() {
  Kept kept;
  kept.head.fault = protocol::Fault::supply_low;
  kept.head.is_complete = 1;
  kept.head.rows_before = protocol::black_box_rows_before;
  kept.head.row_count = protocol::black_box_rows_maximum;
  kept.head.fault_periods = 3000;
  return kept;
}

device::Device device_with(Kept& kept) { return device::Device(std::make_unique<KeepingTransport>(kept)); }

}  // namespace

TEST_CASE("every row of a black box is read once, in order of time") {
  Kept kept = full();
  auto device = device_with(kept);
  const auto head = device.black_box();
  CHECK(head.fault == protocol::Fault::supply_low);
  for (const int asked_between : {0, 1, 5}) {
    kept.asked_between = asked_between;
    const auto rows = device.black_box_rows(head);
    REQUIRE(rows.size() == protocol::black_box_rows_maximum);
    int wrong = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) wrong += rows[i].time_periods != 1000 + 20 * i;
    CHECK(wrong == 0);
  }
}

TEST_CASE("if another program repeatedly requests other rows, black_box_rows raises an error instead of waiting") {
  Kept kept = full();
  kept.asked_between = 1'000'000;
  auto device = device_with(kept);
  const auto head = device.black_box();
  CHECK(contains(message_of<device::InUse>([&] { device.black_box_rows(head); }), "Another program"));
}

TEST_CASE("the reason of a device that refuses to select rows is reported") {
  Kept kept = full();
  kept.result = protocol::RequestResult::malformed;
  auto device = device_with(kept);
  const auto head = device.black_box();
  CHECK(contains(message_of<device::Error>([&] { device.black_box_rows(head); }),
                 "The board refused a request for rows of the black box. The request has a wrong version"));
}

TEST_CASE("a black box that goes while it is read, or another that replaces it, is not mixed up") {
  Kept kept = full();
  auto device = device_with(kept);
  const auto head = device.black_box();
  kept.gone_from = 90;
  CHECK(contains(message_of<device::Error>([&] { device.black_box_rows(head); }), "the force was switched on"));
  kept.gone_from = ~0u;
  kept.head.row_count = 90;
  CHECK(contains(message_of<device::Error>([&] { device.black_box_rows(head); }), "the force was switched on"));
}

TEST_CASE("a black box whose counts cannot be is refused") {
  Kept kept = full();
  auto device = device_with(kept);
  kept.head.row_count += 1;
  CHECK_THROWS_AS(device.black_box(), device::Incompatible);
  kept.head.row_count = 50;
  CHECK_THROWS_AS(device.black_box(), device::Incompatible);
  kept.head.rows_before = 50;
  CHECK(device.black_box().row_count == 50);
}
