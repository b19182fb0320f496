#include "host/lab/campaign/page_detection.hpp"

#include <set>
#include <string_view>

#include <fmt/format.h>

#include "protocol/supervision.hpp"

namespace inkwell::campaign {
namespace {

/// Reason why no case of the campaign can cause the fault.
std::string_view reason_never_reported(protocol::Fault fault) {
  switch (fault) {
    case protocol::Fault::not_finite:
      return "Converters, encoders and hosts always supply finite numbers. Only a flipped RAM bit could produce "
             "another value. The tests of the control path cover this fault.";
    case protocol::Fault::force_law:
      return "The force law of this image returns a finite number for each input. "
             "`tests/system/force_law_fault_test.cpp` tests an image whose law divides by zero.";
    case protocol::Fault::motor_hot:
      return "The current of a motor is reduced before the motor is too hot, and a case is too short to heat it. The "
             "tests of the control path cover this fault.";
    default: return "No reason is known.";
  }
}

constexpr std::string_view table_head = "\n| case | fault, situation, instant | deviation |\n| --- | --- | --- |\n";

std::string row(const Result& result, std::string_view deviation) {
  return fmt::format("| {} | `{}` {} {} | {} |\n", result.number, result.fault.name(), name_of(result.situation),
                     result.phase, deviation);
}

}  // namespace

Section after_another(std::span<const Result> results) {
  unsigned cases = 0, reported = 0, stored = 0, once_cleared = 0;
  auto before = protocol::Fault::none;
  std::string rows;
  std::size_t findings = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || result.told_before == protocol::Fault::none) continue;
    before = result.told_before;
    ++cases;
    reported += result.first_fault == FirstFault::reported;
    stored += result.first_fault == FirstFault::black_box;
    once_cleared += result.told_once_cleared != protocol::Fault::none;
    const bool is_lost = result.first_fault == FirstFault::lost;
    if (!is_lost && result.first_fault != FirstFault::none) continue;
    ++findings;
    rows += row(result, fmt::format("`{}` was {}.", name_of_reported(result.told_before),
                                    is_lost ? "neither reported nor in the black box" : "unknown: no reply"));
  }
  std::string text = "\n## Second fault\n\n";
  if (cases == 0) return {text + "No case was run in which another fault had been reported.\n"};
  text += fmt::format(
      "In {} cases the board reported `{}` before the injection. This fault was still reported in {} of these cases. "
      "In {} cases the board restarted, and its black box contained the fault. After the first fault was cleared, the "
      "injected fault was reported in {} cases.\n",
      cases, name_of_reported(before), reported, stored, once_cleared);
  if (!rows.empty()) text += fmt::format("{}{}", table_head, rows);
  return {text, findings};
}

Section missed_boot_loader(std::span<const Result> results) {
  std::string rows;
  std::size_t findings = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || !result.missed_boot_loader) continue;
    ++findings;
    rows += row(result, "The boot loader was not running at the end.");
  }
  const std::string_view heading = "\n## Boot loader\n\n";
  if (rows.empty()) return {fmt::format("{}No case failed to reach the boot loader.\n", heading)};
  return {fmt::format("{}In these cases the board did not reach the boot loader after the command.\n{}{}", heading,
                      table_head, rows),
          findings};
}

Section never_reported(std::span<const Result> results) {
  std::set<protocol::Fault> reported;
  for (const Result& result : results)
    if (result.error.empty())
      reported.insert({result.detected_as, result.fault_on_healing, result.told_before, result.told_once_cleared,
                       result.noticed_in_use_as.fault});
  std::string rows;
  std::size_t findings = 0;
  for (const protocol::Condition& row : protocol::condition_table)
    if (!reported.contains(row.fault)) {
      ++findings;
      rows += fmt::format("| `{}` | {} |\n", protocol::info(row.fault).name, reason_never_reported(row.fault));
    }
  const std::string_view heading = "\n## Faults that no case reported\n\n";
  if (rows.empty()) return {fmt::format("{}At least one case reported each monitored fault.\n", heading)};
  return {fmt::format("{}The board monitors these faults, but no case reported them.\n\n| fault | reason |\n"
                      "| --- | --- |\n{}",
                      heading, rows),
          findings};
}

}  // namespace inkwell::campaign
