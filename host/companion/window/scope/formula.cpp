#include "host/companion/window/scope/formula.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <muParser.h>

#include "host/client/device/nearest_name.hpp"
#include "protocol/reports.hpp"

namespace inkwell::window {

namespace {

constexpr std::size_t text_maximum = 400;

bool is_of_a_name(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

/// Returns the names of all signals and functions in a formula.
std::vector<std::string_view> names_in(std::string_view text) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < text.size();) {
    if (!is_of_a_name(text[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < text.size() && is_of_a_name(text[i])) ++i;
    if (std::isdigit(static_cast<unsigned char>(text[begin])) == 0) names.push_back(text.substr(begin, i - begin));
  }
  return names;
}

/// Returns true if the text contains an assignment, which muParser would execute.
bool assigns(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool compares_before = i > 0 && std::string_view("<>!=").find(text[i - 1]) != std::string_view::npos;
    const bool compares_after = i + 1 < text.size() && text[i + 1] == '=';
    if (text[i] == '=' && !compares_before && !compares_after) return true;
  }
  return false;
}

std::string in_words(const mu::Parser::exception_type& error) {
  const std::string token = error.GetToken();
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return fmt::format("There is no signal or function `{}`.{}", token,
                         device::suggestion(protocol::known_signals(), token));
    case mu::ecUNEXPECTED_EOF: return "The formula is incomplete: a value is missing after the last operator.";
    case mu::ecMISSING_PARENS: return "A closing parenthesis is missing.";
    case mu::ecUNEXPECTED_PARENS:
      return fmt::format("The parenthesis at character {} has no matching parenthesis.", error.GetPos());
    case mu::ecTOO_MANY_PARAMS:
    case mu::ecTOO_FEW_PARAMS: return fmt::format("`{}` needs a different number of arguments.", token);
    case mu::ecUNEXPECTED_ARG:
    case mu::ecUNEXPECTED_ARG_SEP: return "Use a decimal point instead of a comma.";
    default:
      return fmt::format("`{}` is not allowed at character {}: an operator such as + or * is missing or superfluous.",
                         token, error.GetPos());
  }
}

std::string refusal_of_name(std::string_view name) {
  if (name.empty()) return "Enter a name for the signal, such as force_error_N.";
  if (!std::ranges::all_of(name, is_of_a_name) || std::isdigit(static_cast<unsigned char>(name.front())) != 0)
    return "The name may contain only letters, digits and _, and must start with a letter.";
  if (protocol::find_signal(name)) return fmt::format("{} is a signal of the device. Choose another name.", name);
  return {};
}

}  // namespace

struct FormulaValues::Implementation {
  explicit Implementation(const Formula& formula) : inputs(inputs_of(formula.text)), values(inputs.size()) {
    for (std::size_t i = 0; i < inputs.size(); ++i) parser.DefineVar(std::string(info(inputs[i]).name), &values[i]);
    // muParser rounds halves up, unlike the function of C.
    parser.DefineFun(
        "rint", +[](double value) { return std::nearbyint(value); });
    parser.SetExpr(formula.text);
    if (formula.low_pass_Hz > 0.0)
      share = 1.0 - std::exp(-2.0 * std::numbers::pi * formula.low_pass_Hz / protocol::servo_rate_Hz);
  }

  std::vector<protocol::Signal> inputs;
  std::vector<double> values;  ///< values of the inputs, which the parser reads
  mu::Parser parser;
  double share = 1.0;              ///< share of the new value in the filter output
  std::optional<double> filtered;  ///< empty before the first value and after a lost value
};

FormulaValues::FormulaValues(const Formula& formula) : implementation_(std::make_unique<Implementation>(formula)) {}
FormulaValues::FormulaValues(FormulaValues&&) noexcept = default;
FormulaValues& FormulaValues::operator=(FormulaValues&&) noexcept = default;
FormulaValues::~FormulaValues() = default;

const std::vector<protocol::Signal>& FormulaValues::inputs() const { return implementation_->inputs; }

float FormulaValues::next(std::span<const float> values) {
  auto& self = *implementation_;
  std::ranges::copy(values, self.values.begin());
  const double value = self.parser.Eval();
  if (!std::isfinite(value)) {
    self.filtered.reset();
    return std::nanf("");
  }
  self.filtered = self.filtered ? *self.filtered + self.share * (value - *self.filtered) : value;
  return static_cast<float>(*self.filtered);
}

std::vector<protocol::Signal> inputs_of(std::string_view text) {
  std::vector<protocol::Signal> inputs;
  for (const std::string_view name : names_in(text))
    if (const auto signal = protocol::find_signal(name); signal && std::ranges::find(inputs, *signal) == inputs.end())
      inputs.push_back(*signal);
  return inputs;
}

std::string find_unit(std::string_view text) {
  const auto inputs = inputs_of(text);
  if (inputs.empty() || names_in(text).size() < inputs.size()) return {};
  const std::string_view unit = info(inputs.front()).unit;
  const bool all_alike = std::ranges::all_of(inputs, [&](protocol::Signal each) { return info(each).unit == unit; });
  const bool only_sums = text.find_first_of("*/^<>=!&|?:,") == std::string_view::npos &&
                         std::ranges::all_of(names_in(text), [](std::string_view name) {
                           return name == "abs" || protocol::find_signal(name).has_value();
                         });
  if (!all_alike || !only_sums) return {};
  return unit.empty() ? "1" : std::string(unit);
}

std::string refusal_of(const Formula& formula) {
  if (formula.text.find_first_not_of(' ') == std::string::npos)
    return "Enter a formula, such as force_x_N - program_force_x_N.";
  if (formula.text.size() > text_maximum)
    return fmt::format("The formula may have at most {} characters.", text_maximum);
  if (assigns(formula.text)) return "Remove the = character: the result of the formula is the signal.";
  if (!(formula.low_pass_Hz >= 0.0 && formula.low_pass_Hz <= Formula::low_pass_maximum_Hz))
    return fmt::format("The corner frequency of the filter must be between 0 (no filter) and {} Hz.",
                       Formula::low_pass_maximum_Hz);
  try {
    FormulaValues values(formula);
    if (values.inputs().size() > protocol::scope_signals_maximum)
      return "The formula contains too many signals. Use fewer signals.";
    const std::vector<float> ones(values.inputs().size(), 1.0f);
    values.next(ones);
    mu::Parser counted;
    std::vector<double> variables(ones.size(), 1.0);
    for (std::size_t i = 0; i < variables.size(); ++i)
      counted.DefineVar(std::string(info(values.inputs()[i]).name), &variables[i]);
    counted.SetExpr(formula.text);
    counted.Eval();
    if (counted.GetNumResults() > 1) return "Use a decimal point instead of a comma.";
    if (values.inputs().empty()) return "The formula contains no signal. The list on the left shows all signals.";
  } catch (const mu::Parser::exception_type& error) {
    return in_words(error);
  }
  if (std::string reason = refusal_of_name(formula.name); !reason.empty()) return reason;
  if (formula.unit.empty())
    return "Enter the unit, because it cannot be derived from this formula. Enter 1 for a result without a unit.";
  return {};
}

}  // namespace inkwell::window
