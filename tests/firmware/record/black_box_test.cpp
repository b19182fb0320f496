// Tests the black box, including its content after resets.
#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "tests/firmware/link/fresh_link.hpp"

namespace inkwell {

using protocol::BlackBoxRow;
using protocol::Fault;
using protocol::State;

namespace {

constexpr std::uint32_t step = protocol::black_box_step_periods;
constexpr std::size_t rows_before = 5, rows_from_fault = 4;
constexpr protocol::CrashFacts crash{.exception = 3,
                                     .program_counter = 0x0800'1234,
                                     .link_register = 0x0800'5679,
                                     .configurable_fault_status = 0x8200,
                                     .hard_fault_status = 0x4000'0000,
                                     .fault_address = 0x6000'0000,
                                     .callers = {0x0800'5678, 0x0800'2222}};

float value_at(std::uint32_t period, std::size_t signal) {
  return static_cast<float>(period % 100'000) + 0.125f * static_cast<float>(signal % 8);
}

protocol::SignalValues signals_at(std::uint32_t period) {
  protocol::SignalValues signals;
  for (std::size_t i = 0; i < signals.values.size(); ++i) signals.values[i] = value_at(period, i);
  return signals;
}

protocol::RequestResult result_of(const protocol::BlackBoxRowsReport& report) {
  return static_cast<protocol::RequestResult>(report.result);
}

/// The memory of the record survives restarts of the board. Each start creates a new sample ring with fresh_link().
struct Board {
  link::BlackBoxMemory<rows_before, rows_from_fault> memory{};
  link::SampleRing* samples = nullptr;
  std::optional<link::BlackBox> box;
  std::uint32_t period = 0;

  Board() { start(); }
  void start(Fault raised = Fault::none, const protocol::CrashFacts& facts = {}) {
    samples = &test::fresh_link().samples;
    box.emplace(*samples, memory);
    box->start(raised, facts);
    period = 0;
  }
  /// Runs the interrupt for some periods.
  void pass(std::uint32_t count, State state = State::ready, Fault fault = Fault::none) {
    for (std::uint32_t i = 0; i < count; ++i, ++period) {
      samples->next() = {signals_at(period), {.state = state, .fault = fault, .periods = period}};
      samples->record();
    }
  }
  /// Runs the interrupt for some periods, with a pass of the main loop after each period.
  void run(std::uint32_t count, State state = State::ready, Fault fault = Fault::none) {
    for (std::uint32_t i = 0; i < count; ++i) {
      pass(1, state, fault);
      box->follow();
    }
  }
  std::vector<BlackBoxRow> rows_from(std::uint16_t first) {
    const protocol::BlackBoxRequest request{.first_row = first};
    box->select_rows(std::as_bytes(std::span(&request, 1)));
    const auto report = box->rows();
    REQUIRE(result_of(report) == protocol::RequestResult::accepted);
    CHECK(report.report_id == protocol::ReportId::black_box_rows);
    CHECK(report.first_row == first);
    CHECK(report.fault_periods == box->report().fault_periods);
    REQUIRE(report.row_count <= protocol::black_box_report_rows);
    return {report.rows, report.rows + report.row_count};
  }
  /// Reads all rows like a host and checks all values. Returns the periods of the rows.
  std::vector<std::uint32_t> periods() {
    std::vector<std::uint32_t> found;
    int wrong = 0;
    for (std::uint16_t first = 0;;) {
      const auto rows = rows_from(first);
      if (rows.empty()) break;
      for (const auto& row : rows) {
        found.push_back(row.time_periods);
        for (std::size_t i = 0; i < std::size(row.values); ++i) wrong += row.values[i] != value_at(row.time_periods, i);
      }
      first = static_cast<std::uint16_t>(first + rows.size());
    }
    CHECK(wrong == 0);
    CHECK(found.size() == box->report().row_count);
    return found;
  }
  bool is_kept() const { return box->report().fault != Fault::none; }
};

using Periods = std::vector<std::uint32_t>;

/// Raises a fault in period 1007 and records all later rows.
void meet_fault(Board& board, Fault fault = Fault::supply_low) {
  board.run(1007, State::active);
  board.run(3 * step + 1, State::fault, fault);
}
const Periods around_fault{920, 940, 960, 980, 1000, 1007, 1027, 1047, 1067};

}  // namespace

TEST_CASE("without a fault no black box is kept") {
  Board board;
  board.run(500);
  const auto report = board.box->report();
  CHECK(report.report_id == protocol::ReportId::black_box);
  CHECK(report.fault == Fault::none);
  CHECK(report.row_count == 0);
  CHECK(board.rows_from(0).empty());
}

TEST_CASE("a fault is kept with its period, and rows before, at and after it") {
  Board board;
  board.run(1007, State::active);
  board.run(3 * step, State::fault, Fault::supply_low);
  auto report = board.box->report();
  CHECK(report.fault == Fault::supply_low);
  CHECK(report.fault_periods == 1007);
  CHECK_FALSE(report.is_complete);
  board.run(1, State::fault, Fault::supply_low);
  report = board.box->report();
  CHECK(report.is_complete);
  CHECK_FALSE(report.is_restart);
  CHECK(report.rows_before == rows_before);
  CHECK(report.row_count == rows_before + rows_from_fault);
  CHECK(report.crash.exception == 0);
  CHECK(board.periods() == around_fault);
  board.run(1000, State::fault, Fault::supply_low);
  CHECK(board.periods() == around_fault);
}

TEST_CASE("a fault soon after the start has fewer rows before it") {
  Board board;
  board.run(25);
  board.run(100, State::fault, Fault::current_sensor);
  CHECK(board.box->report().rows_before == 2);
  CHECK(board.periods() == Periods{0, 20, 25, 45, 65, 85});
  Board at_once;
  at_once.run(100, State::fault, Fault::current_sensor);
  CHECK(at_once.box->report().rows_before == 0);
  CHECK(at_once.periods() == Periods{0, 20, 40, 60});
}

TEST_CASE("a black box is retained until the force is switched on") {
  Board board;
  meet_fault(board);
  board.run(500, State::ready);
  board.run(500, State::fault, Fault::bridge_fault);
  board.run(500, State::ready);
  CHECK(board.box->report().fault == Fault::supply_low);
  CHECK(board.periods() == around_fault);

  board.run(1, State::active);
  CHECK_FALSE(board.is_kept());
  CHECK(board.rows_from(0).empty());
  const std::uint32_t on_at = board.period;
  board.run(33, State::active);
  board.run(100, State::fault, Fault::bridge_fault);
  CHECK(board.box->report().fault == Fault::bridge_fault);
  CHECK(board.box->report().fault_periods == on_at + 33);
  for (const std::uint32_t period : board.periods()) CHECK(period >= on_at);  // no row from before
}

TEST_CASE("a late main loop misses rows but neither the fault's period nor anybody's time") {
  for (const std::uint32_t late : {2u, 7u, 20u, 29u, 30u}) {
    Board board;
    const auto pass = [&](std::uint32_t count, State state, Fault fault) {
      for (std::uint32_t i = 0; i < count; i += late) {
        board.pass(std::min(late, count - i), state, fault);
        board.box->follow();
      }
    };
    pass(1007, State::active, Fault::none);
    pass(200, State::fault, Fault::over_speed);
    CHECK(board.box->report().fault_periods == 1007);
    CHECK(board.periods() == around_fault);
  }
  // The main loop is late, so the interrupt has overwritten samples.
  Board board;
  for (int i = 0; i < 20; ++i) {
    board.pass(51, State::active);
    board.box->follow();
  }
  const std::uint32_t fault_at = board.period;
  board.pass(49, State::fault, Fault::over_speed);
  board.box->follow();
  CHECK(board.box->report().fault_periods == fault_at + 49 - link::SampleRing::readable);
  board.run(100, State::fault, Fault::over_speed);
  const auto periods = board.periods();
  CHECK(board.box->report().is_complete);
  CHECK(board.box->report().rows_before > 0);
  for (std::size_t i = 1; i < periods.size(); ++i) CHECK(periods[i] > periods[i - 1]);
}

TEST_CASE("a main loop that runs after the time of a fault adds nothing to the black box") {
  Board board;
  board.run(1008, State::active);
  board.run(step + 1, State::fault, Fault::supply_low);
  board.pass(9 * step + link::SampleRing::readable - 1, State::fault, Fault::supply_low);  // a row is due now
  board.box->follow();
  CHECK(board.box->report().is_complete);
  CHECK(board.periods() == Periods{920, 940, 960, 980, 1000, 1008, 1028});
}

TEST_CASE("a black box that is kept survives resets of every cause") {
  Board board;
  meet_fault(board);
  for (const Fault raised : {Fault::none, Fault::watchdog, Fault::logic_supply_low, Fault::none}) {
    board.start(raised);
    board.run(200, raised == Fault::none ? State::ready : State::fault, raised);
    CHECK(board.box->report().fault == Fault::supply_low);
    CHECK(board.box->report().fault_periods == 1007);
    CHECK(board.box->report().is_complete);
    CHECK_FALSE(board.box->report().is_restart);
    CHECK(board.box->report().crash.exception == 0);
    CHECK(board.box->report().later_crashes == 0);
    CHECK(board.periods() == around_fault);
  }
  board.run(1, State::active);
  CHECK_FALSE(board.is_kept());
  board.start();
  CHECK_FALSE(board.is_kept());
}

TEST_CASE("a reset while a black box is being filled leaves it as far as it got") {
  Board board;
  board.run(1007, State::active);
  board.run(step + 1, State::fault, Fault::supply_low);
  board.start();
  board.run(200);
  CHECK(board.box->report().is_complete);
  CHECK(board.periods() == Periods{920, 940, 960, 980, 1000, 1007, 1027});
}

TEST_CASE("a crash leaves the last rows of the run and the facts of the processor in the black box") {
  Board board;
  board.run(1007, State::active);
  board.start(Fault::processor_fault, crash);
  board.run(200, State::fault, Fault::processor_fault);
  const auto report = board.box->report();
  CHECK(report.fault == Fault::processor_fault);
  CHECK(report.is_restart);
  CHECK(report.is_complete);
  CHECK(report.fault_periods == 1000);
  CHECK(report.rows_before == rows_before);
  CHECK(report.crash.exception == 3);
  CHECK(report.crash.program_counter == 0x0800'1234);
  CHECK(report.crash.link_register == 0x0800'5679);
  CHECK(report.crash.configurable_fault_status == 0x8200);
  CHECK(report.crash.hard_fault_status == 0x4000'0000);
  CHECK(report.crash.fault_address == 0x6000'0000);
  CHECK(board.periods() == Periods{920, 940, 960, 980, 1000});
}

TEST_CASE("each crash while a black box is retained updates the crash facts and the crash count, but not the signals") {
  const auto check = [](Board& board, Fault first_fault, const Periods& first_periods) {
    for (std::uint32_t crashes = 1; crashes <= 2; ++crashes) {
      protocol::CrashFacts newest = crash;
      newest.program_counter += 0x100 * crashes;
      board.start(Fault::processor_fault, newest);
      board.run(200, State::fault, Fault::processor_fault);
      board.start();  // the black box is retained across another reset
      const auto report = board.box->report();
      CHECK(report.fault == first_fault);
      CHECK(report.later_crashes == crashes);
      CHECK(report.crash.program_counter == newest.program_counter);
      CHECK(board.periods() == first_periods);
    }
    board.run(1, State::active);
    CHECK_FALSE(board.is_kept());
    CHECK(board.box->report().later_crashes == 0);
    CHECK(board.box->report().crash.exception == 0);
  };
  Board with_fault;
  meet_fault(with_fault);
  check(with_fault, Fault::supply_low, around_fault);
  Board with_crash;
  with_crash.run(1007, State::active);
  with_crash.start(Fault::processor_fault, crash);
  CHECK(with_crash.box->report().later_crashes == 0);
  check(with_crash, Fault::processor_fault, {920, 940, 960, 980, 1000});
}

TEST_CASE("a crash before the first recorded row is reported without rows") {
  Board board;
  board.start(Fault::processor_fault, crash);
  board.run(200, State::fault, Fault::processor_fault);
  CHECK(board.box->report().fault == Fault::processor_fault);
  CHECK(board.box->report().row_count == 0);
  CHECK(board.box->report().crash.program_counter == 0x0800'1234);
}

TEST_CASE("a crash while a row is written costs that row") {
  Board board;
  board.run(1007, State::active);
  // Row 51 replaces row 46, the oldest row.
  board.memory.ring[51 % rows_before].row.values[7] = 1.0f;
  board.start(Fault::watchdog);
  CHECK(board.periods() == Periods{940, 960, 980, 1000});
}

TEST_CASE("a reset without a fault restarts the black box") {
  Board board;
  board.run(1007, State::active);
  board.start();
  board.run(25);
  board.start(Fault::watchdog);
  CHECK(board.periods() == Periods{0, 20});
}

TEST_CASE("memory after power-up is never taken for a black box") {
  std::uint32_t random = 1;
  for (int i = 0; i < 300; ++i) {
    Board board;
    const auto fill = [&](auto& memory) {
      auto bytes = std::as_writable_bytes(std::span(&memory, 1));
      for (std::byte& byte : bytes) {
        random = random * 1664525u + 1013904223u;
        byte = i == 0 ? std::byte{0} : i == 1 ? std::byte{0xFF} : static_cast<std::byte>(random >> 24);
      }
    };
    if (i % 3 != 2) {
      fill(board.memory);
    } else {
      // The hash of the tables matches, but the memory after the hash is random.
      fill(board.memory.notes.cause);
      fill(board.memory.ring);
      fill(board.memory.line);
      fill(board.memory.notes.rows_written);
      fill(board.memory.notes.rows_added);
    }
    const Fault raised = i % 2 ? Fault::watchdog : Fault::none;
    board.start(raised, crash);
    const bool has_our_tables = i % 3 == 2;
    CHECK(board.is_kept() == (has_our_tables && raised != Fault::none));
    CHECK(board.periods().empty());
    if (board.is_kept()) continue;
    board.run(45, State::ready);
    board.run(100, State::fault, Fault::over_current);
    CHECK(board.periods() == Periods{0, 20, 40, 45, 65, 85, 105});
  }
}

TEST_CASE("a flipped bit costs rows or the black box, and is never shown") {
  for (const bool is_kept : {true, false}) {
    Board board;
    meet_fault(board);
    if (!is_kept) {
      board.run(1, State::active);  // the rows of the previous fault no longer count
      board.period = 0;
      board.run(1007, State::active);
    }
    const auto intact = board.memory;
    const Periods expected = is_kept ? around_fault : Periods{920, 940, 960, 980, 1000};
    const Fault fault = is_kept ? Fault::supply_low : Fault::watchdog;
    for (std::size_t index = 0; index < sizeof intact; index += 3) {
      CAPTURE(index);
      board.memory = intact;
      std::as_writable_bytes(std::span(&board.memory, 1))[index] ^= std::byte{0x10};
      board.start(is_kept ? Fault::none : fault);
      if (!board.is_kept()) continue;
      CHECK(board.box->report().fault == fault);
      const auto periods = board.periods();  // also checks all values
      const std::size_t before = board.box->report().rows_before;
      REQUIRE(before <= rows_before);
      CHECK(board.box->report().fault_periods == (is_kept ? 1007 : periods.empty() ? 0 : 1000));
      // The retained rows are consecutive before and after the fault.
      REQUIRE(periods.size() - before <= expected.size() - rows_before);
      for (std::size_t i = 0; i < periods.size(); ++i)
        CHECK(periods[i] == expected[i < before ? rows_before - before + i : rows_before + i - before]);
    }
  }
}

TEST_CASE("rows of an image with other tables are not shown by this one") {
  Board board;
  meet_fault(board);
  // Reads the memory with a layout that has another number of rows.
  auto& other = reinterpret_cast<link::BlackBoxMemory<rows_before - 1, rows_from_fault + 1>&>(board.memory);
  link::BlackBox box(*board.samples, other);
  box.start(Fault::none, {});
  CHECK(box.report().fault == Fault::none);
}

TEST_CASE("a request for rows with another version or too few bytes is malformed, and the previous request remains") {
  Board board;
  meet_fault(board);
  CHECK(result_of(board.box->rows()) == protocol::RequestResult::accepted);
  protocol::BlackBoxRequest request{.first_row = 1};
  const auto bytes = std::as_bytes(std::span(&request, 1));
  const auto is_malformed = [&](std::span<const std::byte> asked) {
    const auto kept = board.rows_from(5);
    board.box->select_rows(asked);
    const auto report = board.box->rows();
    return result_of(report) == protocol::RequestResult::malformed && report.first_row == 5 &&
           report.row_count == kept.size();
  };
  request.version = protocol::protocol_version + 1;
  CHECK(is_malformed(bytes));
  request.version = protocol::protocol_version;
  CHECK(is_malformed(bytes.first(3)));
  CHECK(is_malformed({}));
  CHECK_FALSE(is_malformed(bytes));
  CHECK(board.rows_from(0xFFFF).empty());
}

TEST_CASE("the board's counter of periods may wrap in the midst of a black box") {
  Board board;
  board.period = 0xFFFF'FFF0;
  board.run(16, State::active);
  board.run(100, State::fault, Fault::over_speed);
  CHECK(board.box->report().fault_periods == 0);
  CHECK(board.periods() == Periods{0xFFFF'FFF0, 0, 20, 40, 60});
}

TEST_CASE("all rows before a fault are there, however many were written since the fault before it") {
  constexpr std::uint32_t written = 51;  // number of rows that meet_fault() records before the fault
  for (const std::uint32_t end_of_numbers : {std::uint32_t{0}, 0x8000'0000 - std::uint32_t{rows_before}}) {
    CAPTURE(end_of_numbers);
    Board board;
    board.memory.notes.rows_written = end_of_numbers - written + 2;
    meet_fault(board);
    CHECK(board.box->report().rows_before == rows_before);
    CHECK(board.periods() == around_fault);
  }
}

}  // namespace inkwell
