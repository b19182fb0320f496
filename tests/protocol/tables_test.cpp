// The tables that both ends read: complete, unambiguous, and their hash notices a change.
#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include <protocol/faults.hpp>
#include <protocol/parameters.hpp>
#include <protocol/reports.hpp>
#include <protocol/scope.hpp>
#include <protocol/signals.hpp>

namespace {

using namespace inkwell::protocol;

bool ends_in_unit(std::string_view name, std::string_view unit) {
  // "N/m" is written N_per_m in a parameter's name, and m/s is m_s in a signal's.
  std::string per, plain;
  for (const char c : unit) {
    if (c == '(' || c == ')') continue;
    per += c == '/' ? "_per_" : std::string{c};
    plain += c == '/' ? '_' : c;
  }
  return unit.empty() || name.ends_with("_" + per) || name.ends_with("_" + plain) ||
         name.ends_with(plain + "_per_turn");
}

TEST_CASE("parameters: names and ids are unique and found, names end in their unit, all have help") {
  std::set<std::string_view> names;
  std::set<std::uint16_t> ids;
  for (std::size_t i = 0; i < parameter_count; ++i) {
    const ParameterInfo& row = parameter_table[i];
    CAPTURE(row.name);
    CHECK(names.insert(row.name).second);
    CHECK(ids.insert(row.id).second);
    CHECK(find_parameter(row.id) == static_cast<Parameter>(i));
    CHECK(find_parameter(row.name) == static_cast<Parameter>(i));
    CHECK(ends_in_unit(row.name, row.unit));
    CHECK(row.help.ends_with('.'));
    CHECK_FALSE(row.group.empty());
    CHECK(row.minimum < row.maximum);
    CHECK(default_parameters().values[i] == row.default_value);
    if (row.kind != ParameterKind::real) CHECK(row.default_value == std::floor(row.default_value));
    if (row.kind == ParameterKind::choice) CHECK(row.maximum - row.minimum <= 8.0f);
  }
  CHECK_FALSE(find_parameter(std::uint16_t{65'535}).has_value());
  CHECK_FALSE(find_parameter("no_such_parameter").has_value());
}

TEST_CASE("the whole parameter set fits one report") {
  CHECK(parameter_count <= parameter_entries_maximum);
  CHECK(parameters_report_size(0) == 8);
  CHECK(parameters_report_size(parameter_entries_maximum) == sizeof(ParametersReport));
}

TEST_CASE("signals: names are unique and found, end in their unit, and all have help") {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < signal_count; ++i) {
    const SignalInfo& row = signal_table[i];
    CAPTURE(row.name);
    CHECK(names.insert(row.name).second);
    CHECK(find_signal(row.name) == static_cast<Signal>(i));
    CHECK(&info(static_cast<Signal>(i)) == &row);
    CHECK(ends_in_unit(row.name, row.unit));
    CHECK(row.help.ends_with('.'));
  }
  CHECK_FALSE(find_signal("no_such_signal").has_value());
}

template <class Table>
void check_codes(const Table& table) {
  std::set<std::string_view> names;
  std::uint16_t next = 0;
  for (const CodeInfo& row : table) {
    CAPTURE(row.name);
    CHECK(row.code == next++);
    CHECK(names.insert(row.name).second);
    CHECK(row.cause.ends_with('.'));
    CHECK(row.remedy.ends_with('.'));
    CHECK(row.remedy.size() >= 10);
  }
}

TEST_CASE("every fault and refusal has a cause and a remedy") {
  check_codes(fault_table);
  check_codes(refusal_table);
  CHECK(info(Fault::supply_low).name == "supply_low");
  CHECK(info(Refusal::given_twice).name == "given_twice");
  CHECK(info(static_cast<Fault>(4'000)).name == "unknown");
  CHECK(info(static_cast<Refusal>(200)).name == "unknown");
}

TEST_CASE("every state has a meaning, and one from another version reads as fault") {
  CHECK(state_table.size() == static_cast<std::size_t>(State::fault) + 1);
  for (const StateInfo& row : state_table) CHECK(row.meaning.ends_with('.'));
  CHECK(info(State::active).name == "active");
  CHECK(info(static_cast<State>(77)).name == "fault");
}

TEST_CASE("a change of an id, a name or a unit changes the tables' hash") {
  const auto hash_of = [](std::uint32_t id, std::string_view name, std::string_view unit) {
    return detail::fnv1a(detail::fnv1a(detail::hash_number(2166136261u, id), name), unit);
  };
  const std::uint32_t hash = hash_of(100, "box_m", "m");
  CHECK(hash == hash_of(100, "box_m", "m"));
  CHECK(hash != hash_of(101, "box_m", "m"));
  CHECK(hash != hash_of(100 + 65'536, "box_m", "m"));
  CHECK(hash != hash_of(100, "bax_m", "m"));
  CHECK(hash != hash_of(100, "box_m", "mm"));
  CHECK(hash != hash_of(100, "box_mm", ""));
  CHECK(parameter_table_hash != signal_table_hash);

  // FNV-1a of "a" is published; the table's form appends a zero byte, so that neighbours do not merge.
  CHECK(detail::fnv1a(2166136261u, "a") == 0xE40C292Cu * 16777619u);
}

TEST_CASE("what is on the wire lies where it should") {
  CHECK(offsetof(PoseReport, fault) == 2);
  CHECK(offsetof(PoseReport, sequence) == 4);
  CHECK(offsetof(PoseReport, position_m) == 12);
  CHECK(offsetof(PoseReport, joint_rad) == 48);
  CHECK(offsetof(PoseReport, supply_dV) == 63);
  CHECK(offsetof(CommandReport, test) == 4);
  CHECK(offsetof(ParametersReport, entries) == 8);
  CHECK(sizeof(ScopeFrameHeader) == 24);
}

TEST_CASE("fourteen floats are the longest selection that goes out in full") {
  SignalSelection selection{};
  selection.count = 14;
  for (std::uint8_t i = 0; i < 14; ++i) selection.signals[i] = i;
  CHECK(full_sample_size(selection) == 56);
  CHECK(encoding_for(selection) == ScopeEncoding::full);
  selection.signals[selection.count++] = static_cast<std::uint8_t>(Signal::duty_1);
  CHECK(full_sample_size(selection) == 58);
  CHECK(encoding_for(selection) == ScopeEncoding::changes);
  CHECK(servo_rate_Hz * 56.0 < 64 * 19 * 1000.0);
}

}  // namespace
