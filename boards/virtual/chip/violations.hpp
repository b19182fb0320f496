// The list of broken rules, each once for each place.
#pragma once

#include <chip/violations.hpp>
#include <functional>
#include <vector>

namespace inkwell::virtual_board {

struct Machine;

class Violations final : public RuleKeeper {
 public:
  explicit Violations(Machine& machine) : machine_(machine) {}
  void violate(Rule rule, const std::string& where = {}) override;
  const std::vector<Violation>& list() const { return list_; }

  /// Called when a rule is broken for the first time at a place.
  std::function<void(const Violation&)> on_first;

 private:
  Machine& machine_;
  std::vector<Violation> list_;
};

}  // namespace inkwell::virtual_board
