// A signal computed from other signals with a formula, such as force_x_N - program_force_x_N.
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

  std::string name;  ///< different from all signal names
  std::string text;  ///< expression of signal names, numbers, + - * / ^ ( ), and functions such as sqrt and abs
  std::string unit;  ///< "1" for a dimensionless value
  /// Corner frequency of the first-order low-pass filter of the result; 0 disables the filter.
  double low_pass_Hz = 0.0;
  bool operator==(const Formula&) const = default;
};

/// Returns the signals in the text, each once.
std::vector<protocol::Signal> inputs_of(std::string_view text);

/// Derives the unit if the text only adds and subtracts signals with the same unit. Otherwise the result is empty, and
/// the author has to enter the unit.
std::string unit_told_by(std::string_view text);

/// Returns why the formula is invalid and what to do; empty if it is valid.
std::string refusal_of(const Formula& formula);

/// Evaluates a formula for consecutive control periods.
class FormulaValues {
 public:
  /// Requires a formula without a refusal.
  explicit FormulaValues(const Formula& formula);
  FormulaValues(FormulaValues&&) noexcept;
  FormulaValues& operator=(FormulaValues&&) noexcept;
  ~FormulaValues();

  const std::vector<protocol::Signal>& inputs() const;
  /// Evaluates the formula for the input values of one control period. NaN (a lost sample) stays NaN.
  float next(std::span<const float> values);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
