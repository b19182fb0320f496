// List of broken rules. Each combination of rule and affected peripheral or pin has one entry.
#pragma once

#include <functional>
#include <vector>
#include "boards/stm32f405/core/rules.hpp"

namespace inkwell::virtual_board {

struct Machine;

class Violations final : public RuleKeeper {
 public:
  explicit Violations(Machine& machine) : machine_(machine) {}
  void violate(Rule rule, const std::string& where = {}) override;
  const std::vector<Violation>& list() const { return list_; }

  /// Called at the first violation of a rule at a peripheral or pin.
  std::function<void(const Violation&)> on_first;

 private:
  Machine& machine_;
  std::vector<Violation> list_;
};

}  // namespace inkwell::virtual_board
