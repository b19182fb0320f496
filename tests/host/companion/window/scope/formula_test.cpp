#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "host/companion/window/scope/formula.hpp"
#include "host/companion/window/scope/scope_layout.hpp"
#include "host/companion/window/scope/signal_history.hpp"

using namespace inkwell;
using namespace inkwell::window;
using protocol::Signal;

namespace {

Formula formula(const std::string& text, const std::string& unit = "N") {
  return {.name = "derived", .text = text, .unit = unit};
}

float value_of(const std::string& text, std::initializer_list<float> inputs) {
  return FormulaValues(formula(text)).next(std::vector<float>(inputs));
}

device::ScopeSamples block(std::uint32_t first_period, std::vector<Signal> signals, std::vector<float> values) {
  const std::size_t count = values.size() / signals.size();
  return {std::move(signals), first_period, count, std::move(values), 0};
}

}  // namespace

TEST_CASE("a formula gives sums, differences, products and functions of signals") {
  CHECK(inputs_of("force_N - 2*force_x_N + force_N") == std::vector{Signal::force_N, Signal::force_x_N});
  CHECK(value_of("force_N - 2*force_x_N", {5.0f, 1.5f}) == doctest::Approx(2.0f));
  CHECK(value_of("force_N * velocity_x_m_s", {5.0f, 0.5f}) == doctest::Approx(2.5f));
  CHECK(value_of("sqrt(force_x_N^2 + force_y_N^2)", {3.0f, 4.0f}) == doctest::Approx(5.0f));
  CHECK(std::isnan(value_of("force_N + 1", {std::nanf("")})));
  CHECK(std::isnan(value_of("1 / force_N", {0.0f})));
}

TEST_CASE("rint rounds halves to even, as in C") {
  for (const auto& [value, rounded] :
       {std::pair{0.5f, 0.0f}, {1.5f, 2.0f}, {2.5f, 2.0f}, {-0.5f, 0.0f}, {-1.5f, -2.0f}}) {
    CAPTURE(value);
    CHECK(value_of("rint(force_N)", {value}) == rounded);
  }
  CHECK(value_of("rint(2.5) + 0 * force_N", {1.0f}) == 2.0f);
}

TEST_CASE("a low-pass filter passes slow changes and restarts after a gap") {
  Formula slow = formula("force_N");
  slow.low_pass_Hz = 100.0;
  FormulaValues values(slow);
  const auto next = [&](float value) { return values.next(std::array{value}); };
  CHECK(next(0.0f) == 0.0f);
  float value = 0.0f;
  const int time_constant_periods = 32;  // 20 kHz / (2 pi 100 Hz)
  for (int i = 0; i < time_constant_periods; ++i) value = next(1.0f);
  CHECK(value == doctest::Approx(1.0 - std::exp(-1.0)).scale(0).epsilon(0.02));
  CHECK(std::isnan(next(std::nanf(""))));
  CHECK(next(7.0f) == 7.0f);
}

TEST_CASE("the unit of a sum is known, that of a product is to be stated") {
  CHECK(find_unit("force_x_N - program_force_x_N") == "N");
  CHECK(find_unit("abs(force_x_N - 0.5)") == "N");
  CHECK(find_unit("duty_1 + duty_2") == "1");
  CHECK(find_unit("force_x_N * velocity_x_m_s").empty());
  CHECK(find_unit("force_x_N + velocity_x_m_s").empty());
  CHECK(find_unit("sqrt(force_x_N)").empty());
  CHECK(refusal_of(formula("force_x_N * velocity_x_m_s", "")).starts_with("Enter the unit"));
  CHECK(refusal_of(formula("force_x_N * velocity_x_m_s", "W")).empty());
}

TEST_CASE("an invalid formula is refused with a sentence that names the mistake") {
  const auto refused = [](const std::string& text, const char* part) {
    const std::string reason = refusal_of(formula(text));
    CAPTURE(text);
    CAPTURE(reason);
    CHECK(reason.find(part) != std::string::npos);
  };
  refused("", "Enter a formula");
  refused("forse_N + 1", "no signal or function `forse_N`. Did you mean");
  refused("force_N +", "formula is incomplete");
  refused("(force_N + 1", "closing parenthesis");
  refused("force_N + 1)", "no matching parenthesis");
  refused("force_N force_x_N", "is not allowed at character");
  refused("force_N + 1,5", "decimal point");
  refused("force_N = 3", "Remove the =");
  refused("1 + 2", "contains no signal");
  refused(std::string(500, '1'), "may have at most");
  Formula wrong = formula("force_N + 1");
  CHECK(refusal_of(wrong).empty());
  wrong.name = "force_N";
  CHECK(refusal_of(wrong).find("is a signal of the device") != std::string::npos);
  wrong.name = "a b";
  CHECK(refusal_of(wrong).find("letters, digits") != std::string::npos);
  wrong.name = "derived";
  for (const double low_pass_Hz : {-1.0, 1e6, std::nan("")}) {
    wrong.low_pass_Hz = low_pass_Hz;
    CHECK(refusal_of(wrong).find("filter") != std::string::npos);
  }
}

TEST_CASE("the history computes a formula for earlier and for later samples") {
  const ScopeSignal twice(formula("2 * force_N"));
  const ScopeSignal elsewhere(formula("2 * supply_V"));
  SignalHistory history(256);
  history.append(block(10, {Signal::force_N, Signal::duty_1}, {1, 0, 2, 0}));
  CHECK(history.find(twice) == nullptr);
  history.derive({twice, elsewhere});
  REQUIRE(history.find(twice) != nullptr);
  CHECK(history.find(elsewhere) == nullptr);  // a signal that the formula needs is not received
  CHECK((*history.find(twice))[1] == 4.0f);
  auto later = block(14, {Signal::force_N, Signal::duty_1}, {3, 0});
  later.lost_before = 2;
  history.append(later);
  CHECK(history.find(twice)->end() == 5);
  CHECK(std::isnan((*history.find(twice))[3]));
  CHECK((*history.find(twice))[4] == 6.0f);
  history.append(block(0, {Signal::supply_V}, {9}));  // another signal selection
  CHECK(history.find(twice) == nullptr);
  CHECK((*history.find(elsewhere))[0] == 18.0f);
}

TEST_CASE("a formula that comes late has its extremes from there on") {
  SignalHistory history(256);
  std::vector<float> values;
  for (int i = 0; i < 300; ++i) values.push_back(static_cast<float>(i));
  history.append(block(0, {Signal::force_N}, values));
  const ScopeSignal negative(formula("0 - force_N"));
  history.derive({negative});
  history.append(block(300, {Signal::force_N}, {300, 301}));
  const SignalSeries* series = history.find(negative);
  REQUIRE(series != nullptr);
  CHECK(series->begin() == history.begin());
  CHECK(series->extremes(0, 1000).minimum == -301.0f);
  CHECK(series->extremes(0, 1000).maximum == -static_cast<float>(history.begin()));
}

TEST_CASE("a recording that is laid over has its own values in the same periods") {
  SignalHistory history(256);
  const ScopeSignal twice(formula("2 * force_N"));
  history.derive({twice});
  history.append(block(0, {Signal::force_N}, {1, 2}));
  CHECK(history.find_over(Signal::force_N) == nullptr);
  const auto over = block(2, {Signal::force_N, Signal::duty_1}, {30, 0, 40, 0});
  history.append(block(2, {Signal::force_N}, {3, 4}), &over);
  REQUIRE(history.find_over(Signal::force_N) != nullptr);
  CHECK((*history.find_over(Signal::force_N))[3] == 40.0f);
  CHECK((*history.find_over(twice))[2] == 60.0f);
  CHECK(history.find_over(Signal::force_N)->begin() == 2);
  CHECK((*history.find(twice))[3] == 8.0f);
  history.append(block(4, {Signal::force_N}, {5}));
  CHECK(history.find_over(Signal::force_N) == nullptr);
}

TEST_CASE("formulas belong to a layout and its plots") {
  ScopeLayout layout{"mine", 1, {{PlotKind::time, "Force", {Signal::force_N}}}};
  const Formula first = formula("force_x_N - force_y_N");
  put_formula(layout, first, "");
  layout.plots.push_back({PlotKind::time, "Derived", {ScopeSignal(first), Signal::force_z_N}});
  CHECK(find_scope_signal("derived", layout.formulas) == ScopeSignal(first));
  CHECK(find_scope_signal("force_N", layout.formulas) == ScopeSignal(Signal::force_N));
  CHECK_FALSE(find_scope_signal("none", layout.formulas));
  CHECK(signals_of(layout) == std::vector{Signal::force_N, Signal::force_x_N, Signal::force_y_N, Signal::force_z_N});
  Formula second = formula("force_x_N");
  second.name = "renamed";
  put_formula(layout, second, "derived");
  REQUIRE(layout.formulas.size() == 1);
  CHECK(layout.plots[1].signals[0] == ScopeSignal(second));
  CHECK(shown_formulas(layout) == std::vector{ScopeSignal(second)});
  remove_formula(layout, "renamed");
  CHECK(layout.formulas.empty());
  CHECK(layout.plots[1].signals == std::vector<ScopeSignal>{Signal::force_z_N});
}
