// Tests the log entries of injected faults, which combine answers of the board and reports of the device.
#include "host/companion/window/panes/fault_log.hpp"

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

using namespace inkwell;
using namespace inkwell::window;
using device::Injection;
using device::Injections;
using protocol::Fault;
using Phase = LoggedInjection::Phase;

namespace {

Injection injection(unsigned number, double at_s, const std::string& fault = "motor_open") {
  return {.number = number, .fault = fault, .of = "2", .at_s = at_s, .has_come = true};
}

Injection to_come(unsigned number, double at_s) {
  Injection scheduled = injection(number, at_s);
  scheduled.has_come = false;
  return scheduled;
}

/// Returns the board's answer at this board time. The firmware started at `run_began_s`.
Injections answer(double board_time_s, std::vector<Injection> faults, double run_began_s = 1.0,
                  double period_s = 50e-6) {
  const double since_s = board_time_s - run_began_s;
  return {.board_time_s = board_time_s,
          .period = static_cast<std::uint64_t>(since_s / period_s + 0.5),
          .period_at_s = board_time_s,
          .faults = std::move(faults)};
}

std::vector<unsigned> numbers(const FaultLog& log) {
  std::vector<unsigned> numbers;
  for (const auto& each : log.faults()) numbers.push_back(each.injection.number);
  return numbers;
}

}  // namespace

TEST_CASE("each fault in the log is planned, then active and then over") {
  FaultLog log;
  log.take(answer(2.0, {to_come(1, 3.0)}));
  REQUIRE(log.faults().size() == 1);
  CHECK(log.faults()[0].phase == Phase::to_come);
  log.take(answer(3.1, {injection(1, 3.0)}));
  REQUIRE(log.faults().size() == 1);
  CHECK(log.faults()[0].phase == Phase::in);
  log.take(answer(3.2, {}));
  REQUIRE(log.faults().size() == 1);
  CHECK(log.faults()[0].phase == Phase::over);
}

TEST_CASE("a fault that is healed before its start disappears from the log") {
  FaultLog log;
  log.take(answer(2.0, {to_come(1, 3.0)}));
  log.take(answer(2.5, {}));
  CHECK(log.faults().empty());
}

TEST_CASE("a fault that ends before the next poll is listed as over") {
  FaultLog log;
  log.add(injection(1, 2.0));
  CHECK(log.faults()[0].phase == Phase::in);
  log.take(answer(2.1, {}));
  REQUIRE(log.faults().size() == 1);
  CHECK(log.faults()[0].phase == Phase::over);
}

TEST_CASE("the log lists all active faults, but only the newest faults that are over") {
  FaultLog log;
  std::vector<Injection> all;
  for (unsigned number = 1; number <= FaultLog::over_maximum + 3; ++number) all.push_back(injection(number, 2.0));
  log.take(answer(2.1, all));
  CHECK(log.faults().size() == FaultLog::over_maximum + 3);
  log.take(answer(2.2, {all[0]}));
  CHECK(numbers(log) == std::vector<unsigned>{1, 4, 5, 6, 7});
}

TEST_CASE("a restart of the board starts a new log") {
  FaultLog log;
  log.take(answer(9.0, {injection(1, 8.0)}));
  log.notice({Fault::supply_low, 150'000});
  log.take(answer(9.1, {injection(1, 8.0)}));
  REQUIRE(log.faults()[0].noticed);
  log.take(answer(1.5, {injection(1, 1.4, "supply_cut")}));
  REQUIRE(log.faults().size() == 1);
  CHECK(log.faults()[0].injection.fault == "supply_cut");
  CHECK_FALSE(log.faults()[0].noticed);
  CHECK(log.faults()[0].phase == Phase::in);
}

TEST_CASE("a reported fault is assigned to each earlier injection, with the time until the end of its control period") {
  FaultLog log;
  log.take(answer(2.0, {injection(1, 1.5), injection(2, 1.999), to_come(3, 2.5)}));
  log.notice({Fault::motor_implausible, 20'100});  // began at 2.005 s
  CHECK(log.waits_for_answer());
  CHECK_FALSE(log.faults()[0].noticed);
  log.take(answer(2.2, {injection(1, 1.5), injection(2, 1.999), injection(4, 2.1), to_come(3, 2.5)}));
  CHECK_FALSE(log.waits_for_answer());
  CHECK(numbers(log) == std::vector<unsigned>{1, 2, 3, 4});
  REQUIRE(log.faults()[0].noticed);
  CHECK(log.faults()[0].noticed->fault == Fault::motor_implausible);
  CHECK(*log.faults()[0].noticed->after_s == doctest::Approx(0.50505));
  CHECK(*log.faults()[1].noticed->after_s == doctest::Approx(0.00605));
  CHECK_FALSE(log.faults()[2].noticed);
  CHECK_FALSE(log.faults()[3].noticed);  // injected later
}

TEST_CASE("the log shows only the first reported fault of an injection") {
  FaultLog log;
  log.take(answer(2.0, {injection(1, 1.9)}));
  log.notice({Fault::supply_low, 20'000});
  log.take(answer(2.1, {injection(1, 1.9)}));
  log.notice({Fault::over_speed, 22'000});
  log.take(answer(2.2, {injection(1, 1.9)}));
  CHECK(log.faults()[0].noticed->fault == Fault::supply_low);
}

TEST_CASE("the log waits for an answer that reaches the control period, but not indefinitely") {
  FaultLog log;
  log.take(answer(2.0, {injection(1, 1.9)}));
  log.notice({Fault::watchdog, 20'500});
  log.take(answer(2.01, {injection(1, 1.9)}));
  CHECK(log.waits_for_answer());
  log.take(answer(2.1, {injection(1, 1.9)}));
  CHECK(*log.faults()[0].noticed->after_s == doctest::Approx(0.12505));

  log.take(answer(2.2, {injection(2, 2.15)}));
  log.notice({Fault::watchdog, 900'000});  // from a run before a reset
  for (int i = 0; i < 20 && log.waits_for_answer(); ++i) log.take(answer(2.3 + 0.1 * i, {injection(2, 2.15)}));
  REQUIRE(log.faults().back().noticed);
  CHECK_FALSE(log.faults().back().noticed->after_s);
}

TEST_CASE("control periods are as long as the board's crystal makes them") {
  FaultLog log;
  const double slow_s = 50.5e-6;
  log.take(answer(2.0, {injection(1, 1.9)}, 1.0, slow_s));
  const auto now = answer(3.0, {injection(1, 1.9)}, 1.0, slow_s);
  log.notice({Fault::supply_low, static_cast<std::uint32_t>(now.period) - 1000});
  log.take(now);
  CHECK(*log.faults()[0].noticed->after_s == doctest::Approx(1.1 - 999 * slow_s));
}

TEST_CASE("after a core stall, the log has no delay for a reported fault until the board restarts") {
  FaultLog log;
  log.take(answer(2.0, {injection(1, 1.9, "core_stalled")}));
  log.notice({Fault::servo_overrun, 17'000});  // earlier than the injection by the board's counter
  log.take(answer(2.1, {injection(1, 1.9, "core_stalled"), injection(3, 2.05, "core_halted")}));
  REQUIRE(log.faults()[0].noticed);
  CHECK_FALSE(log.faults()[0].noticed->after_s);
  CHECK_FALSE(log.faults()[1].noticed);  // injected after the report

  log.take(answer(2.3, {injection(2, 2.25, "core_stalled")}));
  log.notice({Fault::watchdog, 400});
  log.take(answer(2.6, {injection(2, 2.25, "core_stalled")}, 2.5));
  const auto& stalled = log.faults().back();
  REQUIRE(stalled.noticed);
  CHECK(*stalled.noticed->after_s == doctest::Approx(0.27005));
}
