// Tests the conversion of a black box into a recording with one sample per millisecond.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "host/client/recording/black_box.hpp"
#include "host/client/recording/replay.hpp"
#include "host/client/recording/writer.hpp"
#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using namespace inkwell::tests;
using protocol::BlackBoxReport;
using protocol::BlackBoxRow;
using protocol::Signal;

namespace {

constexpr std::uint32_t step = protocol::black_box_step_periods;

/// Rows around a fault in period 2047, which is not a multiple of 1 ms.
std::vector<BlackBoxRow> rows() {
  std::vector<BlackBoxRow> rows;
  for (const std::uint32_t period : {2000, 2020, 2040, 2047, 2067, 2087}) {
    BlackBoxRow row{.time_periods = period, .values = {}};
    for (std::size_t i = 0; i < std::size(row.values); ++i)
      row.values[i] = static_cast<float>(period) + 0.01f * static_cast<float>(i);
    rows.push_back(row);
  }
  return rows;
}

BlackBoxReport head() {
  BlackBoxReport head{};
  head.fault = protocol::Fault::not_finite;
  head.fault_periods = 2047;
  head.rows_before = 3;
  head.row_count = 6;
  return head;
}

Information about() {
  return {.firmware_version = "0.1.0",
          .serial_number = "0123456789ABCDEF01234567",
          .parameters = protocol::default_parameters(),
          .signals = black_box_signals()};
}

}  // namespace

TEST_CASE("both file formats preserve a black box with its mark, its step and non-finite values") {
  const TemporaryDirectory directory;
  auto kept = rows();
  kept[3].values[static_cast<std::size_t>(Signal::force_N)] = std::numeric_limits<float>::quiet_NaN();
  kept[4].values[static_cast<std::size_t>(Signal::force_N)] = -std::numeric_limits<float>::infinity();
  const auto made = of_black_box(head(), kept, about());
  for (const char* name : {"a.h5", "a.csv"}) {
    CAPTURE(name);
    save(made, directory / name);
    const auto read_back = read(directory / name);
    CHECK(read_back.complete);
    CHECK(read_back.remarks.empty());
    CHECK(read_back.information.step_periods == step);
    CHECK(read_back.information.signals.size() == protocol::known_signals().size());
    REQUIRE(read_back.size() == 6);
    CHECK(read_back.lost() == 0);
    CHECK(read_back.periods == made.periods);
    CHECK(read_back.column(Signal::supply_V)[3] == kept[3].values[static_cast<std::size_t>(Signal::supply_V)]);
    CHECK(std::isnan(read_back.column(Signal::force_N)[3]));
    CHECK(std::isinf(read_back.column(Signal::force_N)[4]));
    REQUIRE(read_back.marks.size() == 1);
    CHECK(read_back.marks[0].text == "not_finite");
    CHECK(read_back.marks[0].period == 2047);
  }
}

TEST_CASE("missing rows of a black box count as lost, and rows with a smaller distance do not") {
  auto kept = rows();
  kept.erase(kept.begin() + 1);
  CHECK(of_black_box(head(), kept, about()).lost() == 1);
  kept.erase(kept.begin() + 3);  // there are still 40 periods from the fault to the last row
  CHECK(of_black_box(head(), kept, about()).lost() == 2);
}

TEST_CASE("the time of a black box continues across the wrap of the board counter") {
  constexpr std::int64_t wrap = std::int64_t{1} << 32;
  auto kept = rows();
  for (auto& row : kept) row.time_periods -= 2047;
  auto fault = head();
  fault.fault_periods = 0;
  const auto made = of_black_box(fault, kept, about());
  CHECK(made.periods == std::vector<std::int64_t>{wrap - 47, wrap - 27, wrap - 7, wrap, wrap + 20, wrap + 40});
  CHECK(made.marks[0].period == wrap);
  CHECK(made.lost() == 0);
}

TEST_CASE("a replay of a black box holds each value until the next is due") {
  auto kept = rows();
  kept.erase(kept.begin() + 1);
  Replay replay(of_black_box(head(), kept, about()));
  replay.play();
  const auto passed = replay.advance(1, 1);
  REQUIRE(passed.blocks.size() == 5);
  const std::uint32_t firsts[] = {2000, 2040, 2047, 2067, 2087};
  const std::size_t counts[] = {20, 7, 20, 20, 1}, lost[] = {0, 20, 0, 0, 0};
  for (std::size_t i = 0; i < 5; ++i) {
    const auto& block = passed.blocks[i];
    CHECK(block.first_period == firsts[i]);
    CHECK(block.count == counts[i]);
    CHECK(block.lost_before == lost[i]);
    REQUIRE(block.values.size() == block.count * block.signals.size());
    for (std::size_t j = 0; j < block.count; ++j)
      CHECK(block.values[j * block.signals.size()] == static_cast<float>(firsts[i]));
  }
  replay.seek(0.00235);
  REQUIRE(replay.pose());
  CHECK(replay.pose()->time_periods == 2047);
}

TEST_CASE("a black box without rows, or with damaged ones, is refused with a sentence") {
  CHECK(contains(message_of<device::Error>([] { of_black_box(head(), {}, about()); }), "contains no signals"));
  auto kept = rows();
  std::swap(kept[1], kept[2]);
  CHECK(contains(message_of<device::Error>([&] { of_black_box(head(), kept, about()); }), "chronological order"));
  kept = rows();
  kept[5] = kept[4];
  CHECK(contains(message_of<device::Error>([&] { of_black_box(head(), kept, about()); }), "chronological order"));
}

TEST_CASE("a file of an earlier version, or one that lies, has a sample in each period") {
  const TemporaryDirectory directory;
  for (const char* line : {"", "# step_periods = 0\n", "# step_periods = -3\n", "# step_periods = 1e30\n",
                           "# step_periods = nan\n", "# step_periods = many\n"}) {
    CAPTURE(line);
    std::ofstream(directory / "a.csv") << "# inkwell recording = 1\n"
                                       << line << "time_s,force_N\n0.00005,1\n0.0001,2\n";
    CHECK(read(directory / "a.csv").information.step_periods == 1);
  }
}

TEST_CASE("an existing file is replaced only on request") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.csv") << "precious";
  CHECK(contains(message_of<device::Error>([&] { check_can_be_created(directory / "a.csv"); }), "exists"));
  CHECK_NOTHROW(check_can_be_created(directory / "a.csv", Existing::is_replaced));
  CHECK_THROWS_AS(check_can_be_created(directory / "a.mat", Existing::is_replaced), device::Error);
  CHECK_THROWS_AS(check_can_be_created(directory / "missing" / "a.csv", Existing::is_replaced), device::Error);
}
