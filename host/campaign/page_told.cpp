#include "page_told.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <protocol/supervision.hpp>

namespace inkwell::campaign {
namespace {

std::string name_of_case(const Result& result) {
  return fmt::format("`{}` {} {}", result.fault, result.situation, result.phase);
}

}  // namespace

std::string after_another(std::span<const Result> results) {
  unsigned cases = 0, told = 0, kept = 0, once_cleared = 0;
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
    told += result.first_fault == FirstFault::told;
    kept += result.first_fault == FirstFault::black_box;
    once_cleared += !result.told_once_cleared.empty();
    if (result.first_fault == FirstFault::lost || result.first_fault == FirstFault::none)
      row(result, fmt::format("neither told nor in the black box: {}", result.told_before));
  }
  std::string text = "\n## After another fault, and on the way to the boot loader\n\n";
  if (cases == 0)
    text += "No case was run in which another fault had been told.\n";
  else
    text += fmt::format(
        "In {} cases {} had been told before: it still was in {} of them, and in {} the board started anew and had it "
        "in its black box. Once it was cleared, the other one was told in {}.\n",
        cases, before, told, kept, once_cleared);
  if (rows.empty()) return text;
  return text + "\n| case | what | what was missed |\n| --- | --- | --- |\n" + rows;
}

std::string fast_hand(std::span<const Result> results) {
  double with_N = 0, without_N = 0;
  unsigned with = 0, without = 0, told = 0;
  for (const Result& result : results) {
    if (!result.error.empty() || !is_flung(result)) continue;
    if (!result.bridges_were_on || is_testing(result)) {
      ++without;
      without_N = std::max(without_N, result.peak_force_N);
    } else {
      ++with;
      with_N = std::max(with_N, result.peak_force_N);
      told += result.detected_as == protocol::info(protocol::Fault::over_speed).name;
    }
  }
  std::string text = fmt::format(
      "\n## A fast hand\n\nIn `fast_hand` nothing fails: the hand flings the arm {:.0f} mm along x within {} s, which "
      "is "
      "faster than it may be under a force.",
      1e3 * fling_m, fling_s);
  if (without > 0) text += fmt::format(" That takes up to {:.2f} N without a force.", without_N);
  if (with > 0)
    text += fmt::format(" With the force on the hand felt up to {:.2f} N, and {} was told in {} of {} cases.", with_N,
                        protocol::info(protocol::Fault::over_speed).name, told, with);
  return text + (with + without == 0 ? " No such case was run.\n" : "\n");
}

}  // namespace inkwell::campaign
