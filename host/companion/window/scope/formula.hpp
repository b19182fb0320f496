// A formula computes a new signal from device signals. Example: force_x_N - program_force_x_N.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/signals.hpp"

namespace inkwell::window {

struct Formula {
  static constexpr double low_pass_maximum_Hz = 5000.0;

  std::string name;  ///< different from all signal names
  std::string text;  ///< expression with signal names, numbers, + - * / ^ ( ), and functions such as sqrt and abs
  std::string unit;  ///< "1" for a dimensionless value
  /// Corner frequency of a first-order low-pass filter for the result; 0 disables the filter.
  double low_pass_Hz = 0.0;
  bool operator==(const Formula&) const = default;
};

/// Returns the signals in the text, without repetitions.
std::vector<protocol::Signal> inputs_of(std::string_view text);

/// Returns the unit if the text only adds and subtracts signals with the same unit. For other formulas, returns an
/// empty text.
std::string find_unit(std::string_view text);

/// Returns the error of the formula and the remedy; empty if the formula is valid.
std::string refusal_of(const Formula& formula);

/// Evaluates a formula for consecutive control periods.
class FormulaValues {
 public:
  /// Requires a valid formula (refusal_of() is empty).
  explicit FormulaValues(const Formula& formula);
  FormulaValues(FormulaValues&&) noexcept;
  FormulaValues& operator=(FormulaValues&&) noexcept;
  ~FormulaValues();

  const std::vector<protocol::Signal>& inputs() const;
  /// Evaluates the formula for the input values of one control period. The result for a lost sample (NaN) is NaN.
  float next(std::span<const float> values);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::window
