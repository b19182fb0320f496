#include "page_told.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include <protocol/supervision.hpp>

namespace inkwell::campaign {
namespace {

/// Reason why no case of the campaign can cause the fault.
std::string_view reason_unreported(protocol::Fault fault) {
  switch (fault) {
    case protocol::Fault::not_finite:
      return "What converters, encoders and hosts give is always a number; only a bit of the RAM that flips might make "
             "one that is none. The tests of the control path give it such numbers.";
    case protocol::Fault::force_law:
      return "The law of this image gives a number for all that it may be given; an image whose law divides by zero "
             "has a test of its own, `tests/system/force_law_fault_test.cpp`.";
    case protocol::Fault::motor_hot:
      return "A motor gets less long before it is too hot, and a case is too short to heat one; the tests of the "
             "control path do.";
    default: return "None is known.";
  }
}

std::string name_of_case(const Result& result) {
  return fmt::format("`{}` {} {}", result.fault, result.situation, result.phase);
}

}  // namespace

std::string after_another(std::span<const Result> results) {
  unsigned cases = 0, reported = 0, kept = 0, once_cleared = 0;
  std::string before, rows;
  const auto row = [&](const Result& result, std::string_view what) {
    rows += fmt::format("| {} | {} | {} |\n", result.number, name_of_case(result), what);
  };
  for (const Result& result : results) {
    if (!result.error.empty()) continue;
    if (result.missed_boot_loader) row(result, "not in its boot loader, though it was asked to go there");
    if (result.told_before.empty()) continue;
    before = result.told_before;
    ++cases;
    reported += result.first_fault == FirstFault::reported;
    kept += result.first_fault == FirstFault::black_box;
    once_cleared += !result.told_once_cleared.empty();
    if (result.first_fault == FirstFault::lost)
      row(result, fmt::format("neither told nor in the black box: {}", result.told_before));
    if (result.first_fault == FirstFault::none)
      row(result, fmt::format("the board could not be asked for it: {}", result.told_before));
  }
  std::string text = "\n## After another fault, and on the way to the boot loader\n\n";
  if (cases == 0)
    text += "No case was run in which another fault had been told.\n";
  else
    text += fmt::format(
        "In {} cases {} had been told before: it still was in {} of them, and in {} the board started anew and had it "
        "in its black box. Once it was cleared, the other one was told in {}.\n",
        cases, before, reported, kept, once_cleared);
  if (rows.empty()) return text;
  return text + "\n| case | what | what was missed |\n| --- | --- | --- |\n" + rows;
}

std::string fast_hand(std::span<const Result> results) {
  double with_N = 0, without_N = 0;
  unsigned with = 0, without = 0, reported = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || !is_flung(result)) continue;
    if (!result.bridges_were_on || is_testing(result)) {
      ++without;
      without_N = std::max(without_N, result.peak_force_N);
    } else {
      ++with;
      with_N = std::max(with_N, result.peak_force_N);
      reported += result.detected_as == protocol::info(protocol::Fault::over_speed).name;
    }
  }
  std::string text = fmt::format(
      "\n## A fast hand\n\nIn `fast_hand` nothing fails: the hand flings the arm {:.0f} mm along x within {} s, which "
      "is faster than it may be under a force.",
      1e3 * fling_m, fling_s);
  if (without > 0) text += fmt::format(" That takes up to {:.2f} N without a force.", without_N);
  if (with > 0)
    text += fmt::format(" With the force on the hand felt up to {:.2f} N, and {} was told in {} of {} cases.", with_N,
                        protocol::info(protocol::Fault::over_speed).name, reported, with);
  return text + (with + without == 0 ? " No such case was run.\n" : "\n");
}

std::string unreported_faults(std::span<const Result> results) {
  std::set<std::string_view> reported;
  for (const Result& result : results)
    if (result.error.empty())
      for (const std::string* name : {&result.detected_as, &result.fault_on_healing, &result.told_before,
                                      &result.told_once_cleared, &result.noticed_in_use_as})
        reported.insert(*name);
  std::string rows;
  for (const protocol::Condition& row : protocol::condition_table)
    if (const std::string_view name = protocol::info(row.fault).name; !reported.contains(name))
      rows += fmt::format("| `{}` | {} |\n", name, reason_unreported(row.fault));
  const std::string_view heading =
      "\n## Told by none\n\nFaults that the board watches for, and no case that was run told";
  if (rows.empty()) return fmt::format("{}: none.\n", heading);
  return fmt::format("{}.\n\n| fault | reason |\n| --- | --- |\n{}", heading, rows);
}

}  // namespace inkwell::campaign
