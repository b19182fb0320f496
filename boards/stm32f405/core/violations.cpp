#include "boards/stm32f405/core/violations.hpp"

#include <algorithm>
#include <cstdio>

#include "boards/stm32f405/core/log.hpp"
#include "boards/stm32f405/core/timeline.hpp"

namespace inkwell::virtual_board {

std::string sentence(const Violation& violation) {
  const RuleInfo& rule = info(violation.rule);
  std::string text(rule.done);
  if (!violation.where.empty()) text += " (" + violation.where + ")";
  text.append(". On silicon, ").append(rule.consequence).append(". Remedy: ").append(rule.remedy);
  char code[32];
  std::snprintf(code, sizeof code, "code 0x%08X, ", static_cast<unsigned>(violation.code_address));
  return text.append(" [").append(code).append(rule.of_register).append("; ").append(rule.section).append("]");
}

void Violations::violate(Rule rule, const std::string& where) {
  const auto known = std::find_if(list_.begin(), list_.end(),
                                  [&](const Violation& it) { return it.rule == rule && it.where == where; });
  if (known != list_.end()) {
    ++known->count;
    return;
  }
  list_.push_back({rule, where, code_.code_address(), timeline_.now()});
  log_.say(sentence(list_.back()));
  if (on_first) on_first(list_.back());
}

}  // namespace inkwell::virtual_board
