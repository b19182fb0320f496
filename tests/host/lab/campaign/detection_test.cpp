// Tests the page sections about a second fault, the boot loader, a fast hand, and unreported faults.
#include "host/lab/campaign/cases.hpp"
#include "host/lab/campaign/page.hpp"
#include "host/lab/campaign/result.hpp"

#include <string>
#include <vector>

#include <doctest/doctest.h>
#include "tests/temporary_directory.hpp"

#include "protocol/supervision.hpp"

#include "tests/host/lab/campaign/seen_cases.hpp"

using namespace inkwell;
using namespace inkwell::campaign;
using inkwell::tests::content_of;
using inkwell::tests::pages_of;
using inkwell::tests::seen;
using inkwell::tests::TemporaryDirectory;

namespace {

std::string page_of(const std::vector<Result>& results) {
  const TemporaryDirectory directory;
  write_page(results, directory / "campaign.md");
  return pages_of(directory / "campaign.md");
}

std::string section_of(const std::string& page, const std::string& heading) {
  const auto begin = page.find("\n## " + heading + "\n");
  REQUIRE(begin != std::string::npos);
  return page.substr(begin, page.find("\n## ", begin + 1) - begin);
}

/// Returns the result of a case in which another fault was reported first.
Result after_first(const std::string& fault, FirstFault first_fault) {
  Result result = seen(fault, "fault", 1);
  result.told_before = protocol::Fault::host_silent;
  result.first_fault = first_fault;
  return result;
}

}  // namespace

TEST_CASE("earlier faults are counted by their outcome, and each lost one has a row") {
  Result tripped = after_first("bridge_fault", FirstFault::reported),
         quiet = after_first("dma_stopped", FirstFault::reported),
         restarted = after_first("core_stalled", FirstFault::black_box),
         lost = after_first("logic_sag", FirstFault::lost), mute = after_first("usb_cut", FirstFault::none),
         failed = after_first("ram_bit", FirstFault::lost);
  tripped.told_once_cleared = protocol::Fault::bridge_fault;
  restarted.detected_as = protocol::Fault::watchdog;
  failed.error = "The board did not start.";
  CHECK(is_detected(tripped));
  CHECK_FALSE(is_detected(quiet));
  const std::string page = page_of({tripped, quiet, restarted, lost, mute, failed});
  const std::string section = section_of(page, "Second fault");
  CHECK(section.find(
            "In 5 cases the board reported `host_silent` before the injection. This fault was still reported in 2 of "
            "these cases. In 1 cases the board restarted, and its black box contained the fault. After the "
            "first fault was cleared, the injected fault was reported in 1 cases.\n") != std::string::npos);
  const auto row = [](const Result& of, const std::string& what) {
    return "| " + std::to_string(of.number) + " | `" + of.fault.name() + "` fault 1 | `host_silent` was " + what +
           ". |";
  };
  CHECK(section.find(row(lost, "neither reported nor in the black box")) != std::string::npos);
  CHECK(section.find(row(mute, "unknown: no reply")) != std::string::npos);
  for (const Result* each : {&tripped, &quiet, &restarted, &failed})
    CHECK(section.find("`" + each->fault.name() + "`") == std::string::npos);
  CHECK(page.find("| `bridge_fault` | bridge_fault after clearing | already off |") != std::string::npos);
  CHECK(section_of(page_of({seen("none", "rest", 1)}), "Second fault").find("No case was run in which") !=
        std::string::npos);
}

TEST_CASE("a board that did not reach its boot loader has a row") {
  Result there = seen("bridge_fault", "update", 1), astray = seen("core_stalled", "update", 1);
  astray.missed_boot_loader = true;
  const std::string section = section_of(page_of({there, astray}), "Boot loader");
  CHECK(section.find("| " + std::to_string(astray.number) +
                     " | `core_stalled` update 1 | The boot loader was not running at the end. |") !=
        std::string::npos);
  CHECK(section.find("`bridge_fault`") == std::string::npos);
}

TEST_CASE(
    "the force of a hand that flings the arm is compared with that without a force, and excluded from other values") {
  Result free = seen("fast_hand", "ready", 1), tested = seen("fast_hand", "testing", 1),
         flung = seen("fast_hand", "rest", 1), missed = seen("fast_hand", "wall", 1),
         failed = seen("fast_hand", "wall", 2), fault_free = seen("none", "rest", 1);
  free.peak_force_N = 8.9;
  tested.bridges_were_on = true;
  tested.peak_force_N = 9.1;
  flung.peak_force_N = 7.65;
  flung.detected_as = protocol::Fault::over_speed;
  flung.off_after_s = 0.15;
  missed.peak_force_N = 7.5;
  failed.error = "The board did not start.";
  fault_free.peak_force_N = 2.0;
  const std::string page = page_of({free, tested, flung, missed, failed, fault_free});
  const std::string section = section_of(page, "Fast hand");
  CHECK(section.find("moves the arm 140 mm along x within 0.085 s") != std::string::npos);
  CHECK(section.find(
            "Without a force from the motors, this motion requires up to 9.10 N at the hand. With the force on, the "
            "force on the hand was up to 7.65 N, and `over_speed` was reported in 1 of 2 cases.\n") !=
        std::string::npos);
  CHECK(page.find("the largest force on the hand was 2.00 N (`none` in rest)") != std::string::npos);
  CHECK(page.find("no case exceeded 105 % of the force limit.") != std::string::npos);
  CHECK(section_of(page, "Undetected with the force on").find("| `fast_hand` | wall | ") != std::string::npos);
  CHECK(section_of(page_of({fault_free}), "Fast hand").find("No such case was run.") != std::string::npos);
  const TemporaryDirectory directory;
  write_page(std::array{flung, fault_free}, directory / "campaign.md");
  CHECK(content_of(directory / "campaign/off.svg").find("#3b6ea5\"") ==
        content_of(directory / "campaign/off.svg").rfind("#3b6ea5\""));  // the legend only, no bar
}

TEST_CASE("monitored faults that no case reported are listed with a reason, whenever the others were reported") {
  std::vector<Result> results;
  const auto report_in = [&](protocol::Fault Result::*when, protocol::Fault fault) {
    results.push_back(seen("bridge_fault", "rest", 1));
    results.back().*when = fault;
  };
  report_in(&Result::detected_as, protocol::Fault::watchdog);
  report_in(&Result::fault_on_healing, protocol::Fault::heartbeat_missed);
  report_in(&Result::told_before, protocol::Fault::host_silent);
  report_in(&Result::told_once_cleared, protocol::Fault::bridge_wire);
  results.push_back(seen("bridge_fault", "rest", 1));
  results.back().noticed_in_use_as = {NoticedInUse::By::fault, protocol::Fault::encoder_wire};
  const std::string some = section_of(page_of(results), "Faults that no case reported");
  for (const char* name : {"watchdog", "heartbeat_missed", "host_silent", "bridge_wire", "encoder_wire"})
    CHECK(some.find("`" + std::string(name) + "`") == std::string::npos);
  CHECK(some.find("| `over_speed` | No reason is known. |") != std::string::npos);
  CHECK(some.find("| `force_law` | The force law of this image returns a finite number") != std::string::npos);
  CHECK(some.find("| `not_finite` | Converters") != std::string::npos);
  CHECK(some.find("| `motor_hot` | The current of a motor is reduced") != std::string::npos);
  results.back().error = "The board did not start.";
  CHECK(section_of(page_of(results), "Faults that no case reported").find("`encoder_wire`") != std::string::npos);
  for (const protocol::Condition& row : protocol::condition_table) report_in(&Result::detected_as, row.fault);
  CHECK(section_of(page_of(results), "Faults that no case reported")
            .ends_with("At least one case reported each monitored fault.\n"));
}
