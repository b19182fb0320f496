// List of broken rules. Each combination of rule and affected peripheral or pin has one entry.
#pragma once

#include <functional>
#include <vector>
#include "boards/stm32f405/core/rules.hpp"

namespace inkwell::virtual_board {

class Log;
class Timeline;

/// Address of the running code.
class CodePosition {
 public:
  virtual ~CodePosition() = default;
  /// Address of the current instruction (fast mode: of the current block).
  virtual std::uint32_t code_address() const = 0;
};

class Violations final : public RuleKeeper {
 public:
  Violations(Log& log, const Timeline& timeline, const CodePosition& code)
      : log_(log), timeline_(timeline), code_(code) {}
  void violate(Rule rule, const std::string& where = {}) override;
  const std::vector<Violation>& list() const { return list_; }

  /// Called at the first violation of a rule at a peripheral or pin.
  std::function<void(const Violation&)> on_first;

 private:
  Log& log_;
  const Timeline& timeline_;
  const CodePosition& code_;
  std::vector<Violation> list_;
};

}  // namespace inkwell::virtual_board
