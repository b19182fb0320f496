#include "page_told.hpp"

#include <string_view>

#include <fmt/format.h>

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

}  // namespace inkwell::campaign
