// A signal that is made of others by a formula, such as force_x_N - program_force_x_N.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <protocol/signals.hpp>

namespace inkwell::window {

struct Formula {
  static constexpr double low_pass_maximum_Hz = 5000.0;

  std::string name;  ///< unlike every signal's
  std::string text;  ///< names of signals, numbers, + - * / ^ ( ), functions such as sqrt and abs
  std::string unit;  ///< "1" for a number without one
  /// The result goes through a filter of first order with this corner; 0: it does not.
  double low_pass_Hz = 0.0;
  bool operator==(const Formula&) const = default;
};

/// The signals that are named in the text, each once.
std::vector<protocol::Signal> inputs_of(std::string_view text);

/// The unit, if the text only adds and subtracts signals that share one; else empty: its author has to state it.
std::string unit_told_by(std::string_view text);

/// Why this is no formula that could be drawn, and what to do: a sentence. Empty if it is one.
std::string refusal_of(const Formula& formula);

/// Values of a formula, one after the other.
class FormulaValues {
 public:
  /// Of a formula that is not refused.
  explicit FormulaValues(const Formula& formula);
  FormulaValues(FormulaValues&&) noexcept;
  FormulaValues& operator=(FormulaValues&&) noexcept;
  ~FormulaValues();

  const std::vector<protocol::Signal>& inputs() const;
  /// Of the inputs' values in one control period, in their order. NaN, for a sample that was lost, stays NaN.
  float next(std::span<const float> values);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
