// Tests the tables of firmware and host: completeness, unique names and hashes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "protocol/faults.hpp"
#include "protocol/parameters.hpp"
#include "protocol/report_table.hpp"
#include "protocol/reports.hpp"
#include "protocol/request_result.hpp"
#include "protocol/scope.hpp"
#include "protocol/signals.hpp"
#include "protocol/store.hpp"

namespace {

using namespace inkwell::protocol;

bool ends_in_unit(std::string_view name, std::string_view unit) {
  // The name of a parameter contains N_per_m for "N/m". The name of a signal contains m_s for "m/s".
  std::string per, plain;
  for (const char c : unit) {
    if (c == '(' || c == ')') continue;
    per += c == '/' ? "_per_" : std::string{c};
    plain += c == '/' ? '_' : c;
  }
  return unit.empty() || name.ends_with("_" + per) || name.ends_with("_" + plain) ||
         name.ends_with(plain + "_per_turn");
}

/// Help text of a signal whose value is a sum of bits: the text `begin` and all bits of the table.
template <class Table, class Bit>
std::string help_of_bits(std::string begin, const Table& table, Bit bit) {
  for (const auto& row : table)
    begin += (&row == &table[0] ? " " : ", ") + std::to_string(static_cast<unsigned>(row.*bit)) + " " +
             std::string(row.name);
  return begin + ".";
}

TEST_CASE("signals: the help of a sum of bits names each bit of its table") {
  CHECK(std::string(info(Signal::force_sources).help) ==
        help_of_bits("Sum of the active force sources:", force_source_table, &ForceSourceInfo::source));
  CHECK(std::string(info(Signal::limits).help) ==
        help_of_bits("Sum of the active limits:", limit_table, &LimitInfo::limit));
}

TEST_CASE("reports: ids and usages are unique, and each is read or set") {
  std::set<ReportId> ids;
  std::set<unsigned> usages;
  for (std::size_t i = 0; i < report_table.size(); ++i) {
    const ReportInfo& row = report_table[i];
    CAPTURE(static_cast<unsigned>(row.id));
    CHECK(ids.insert(row.id).second);
    CHECK(usages.insert(row.usage).second);
    CHECK(find_report(row.kind, row.id) == &row);
    const bool can_be_used = row.can_be_read || row.can_be_set();
    CHECK(can_be_used);
    CHECK(row.can_be_read == (report_texts[i].get != "none"));
    CHECK(report_texts[i].meaning.ends_with('.'));
  }
  CHECK(find_report(ReportKind::input, ReportId::command) == nullptr);
  CHECK(find_report(ReportKind::feature, static_cast<ReportId>(0)) == nullptr);
}

TEST_CASE("results of requests: each has its name, meaning and remedy; other codes are unknown") {
  std::set<std::string_view> names;
  for (const RequestResultInfo& row : request_result_table) {
    CHECK(names.insert(row.name).second);
    CHECK(row.meaning.ends_with('.'));
    CHECK(row.remedy.ends_with('.'));
  }
  CHECK(info(RequestResult::busy).name == "busy");
  CHECK(info(static_cast<RequestResult>(request_result_table.size())).name == "unknown");
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
    CHECK(std::string_view(row.help).ends_with('.'));
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
  CHECK(parameters_report_size(0) == 12);
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
    CHECK(std::string_view(row.help).ends_with('.'));
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
    CHECK(std::string_view(row.cause).ends_with('.'));
    CHECK(std::string_view(row.remedy).ends_with('.'));
    CHECK(std::string_view(row.remedy).size() >= 10);
  }
}

TEST_CASE("every fault and refusal has a cause and a remedy") {
  check_codes(fault_table);
  check_codes(refusal_table);
  CHECK(info(Fault::supply_low).name == "supply_low");
  CHECK(info(Refusal::given_twice).name == "given_twice");
  CHECK(info(static_cast<Fault>(200)).name == "unknown");
  CHECK(info(static_cast<Refusal>(200)).name == "unknown");
}

TEST_CASE("every state and event has a meaning, and a state of another version has no force") {
  CHECK(state_table.size() == static_cast<std::size_t>(State::testing) + 1);
  for (const EventInfo& row : event_table) CHECK(*row.meaning != '\0');
  for (const StateInfo& row : state_table) CHECK(std::string_view(row.meaning).ends_with('.'));
  CHECK(info(State::active).name == "active");
  CHECK(info(State::limited).name == "limited");
  CHECK(info(static_cast<State>(200)).name == "unknown");
  CHECK_FALSE(force_is_on(static_cast<State>(200)));
  CHECK(info(static_cast<State>(state_table.size())).name == "unknown");
}

TEST_CASE("each result of a store command has a meaning and a remedy") {
  std::set<std::string_view> names;
  for (const StoreResultInfo& row : store_result_table) {
    CAPTURE(row.name);
    CHECK(names.insert(row.name).second);
    CHECK(row.meaning.ends_with('.'));
    CHECK(row.remedy.ends_with('.'));
  }
  for (const StoreContentsInfo& row : store_contents_table) {
    CHECK(names.insert(row.name).second);
    CHECK(row.meaning.ends_with('.'));
  }
  CHECK(info(StoreResult::no_room).name == "no_room");
  CHECK(info(StoreContents::other_schema).name == "other_schema");
  CHECK(info(static_cast<StoreResult>(200)).name == "unknown");
  CHECK(info(static_cast<StoreContents>(200)).name == "unknown");
}

TEST_CASE("may_store returns true only in the states unreferenced, ready and fault") {
  for (std::size_t i = 0; i < state_count; ++i) {
    const auto state = static_cast<State>(i);
    CAPTURE(info(state).name);
    const bool is_still = state == State::unreferenced || state == State::ready || state == State::fault;
    CHECK(may_store(state) == is_still);
    if (is_still) CHECK_FALSE(force_is_on(state));
  }
  CHECK_FALSE(may_store(static_cast<State>(200)));
}

template <class Table, class Hash>
void check_hash_notices(const Table& table, std::uint32_t hash, Hash hash_of) {
  CHECK(hash_of(table) == hash);
  for (const std::size_t i : {std::size_t{0}, table.size() / 2, table.size() - 1}) {
    CAPTURE(table[i].name);
    static Table changed;  // too large for the target's stack
    changed = table;
    ++changed[i].id;
    CHECK(hash_of(changed) != hash);
    changed = table;
    changed[i].name = "another";
    CHECK(hash_of(changed) != hash);
    changed = table;
    changed[i].unit = "furlong";
    CHECK(hash_of(changed) != hash);
  }
}

TEST_CASE("a change of an id, a name, a unit or a wire changes the tables' hash") {
  check_hash_notices(parameter_table, parameter_table_hash, [](const auto& t) { return detail::hash_parameters(t); });
  check_hash_notices(signal_table, signal_table_hash, [](const auto& t) { return detail::hash_signals(t); });
  static auto changed = signal_table;
  changed[3].wire = SignalWire::duty_int16;
  CHECK(detail::hash_signals(changed) != signal_table_hash);
  const std::array one_row{SignalInfo{3, "name", "unit", SignalWire::duty_int16, ""}};
  CHECK(detail::hash_signals(one_row) ==
        detail::fnv1a(detail::fnv1a(detail::hash_number(2166136261u, 3 + 2 * 256), "name"), "unit"));
  // The hash depends on every byte of a number and on the boundaries between texts.
  for (const std::uint32_t bit : {0u, 8u, 16u, 31u})
    CHECK(detail::hash_number(2166136261u, 1u << bit) != detail::hash_number(2166136261u, 0));
  CHECK(detail::fnv1a(detail::fnv1a(1, "ab"), "c") != detail::fnv1a(detail::fnv1a(1, "a"), "bc"));
  // The hash of "a" is a published FNV-1a value. The tables append a zero byte to each text.
  CHECK(detail::fnv1a(2166136261u, "a") == 0xE40C292Cu * 16777619u);
}

TEST_CASE("the rows for three axes are found by their names") {
  CHECK(of_axis(Parameter::gear_ratio_1, 0) == Parameter::gear_ratio_1);
  CHECK(of_axis(Parameter::gear_ratio_1, 2) == Parameter::gear_ratio_3);
  CHECK(of_axis(Parameter::gimbal_1_slope_rad, 1) == Parameter::gimbal_2_slope_rad);
  CHECK(of_axis(Parameter::box_minimum_x_m, 2) == Parameter::box_minimum_z_m);
  CHECK(of_number(Parameter::motor_1_reversed, 1) == Parameter::motor_1_reversed);
  CHECK(of_number(Parameter::motor_1_reversed, 3) == Parameter::motor_3_reversed);
  CHECK(of_axis(lower_stops, 2) == Parameter::elbow_minimum_rad);
  CHECK(of_axis(upper_stops, 1) == Parameter::joint_2_maximum_rad);
  CHECK(of_axis(Signal::velocity_x_m_s, 1) == Signal::velocity_y_m_s);
  CHECK(of_number(Signal::current_reference_1_A, 2) == Signal::current_reference_2_A);
  ParameterSet set{};
  set[Parameter::origin_x_m] = 1.0f;
  set[Parameter::origin_y_m] = 2.0f;
  set[Parameter::origin_z_m] = 3.0f;
  CHECK(set.of_each(Parameter::origin_x_m) == std::array{1.0f, 2.0f, 3.0f});
}

TEST_CASE("names that differ only in the axis belong to the rows of one group") {
  CHECK(detail::is_named_after("gear_ratio_2", "gear_ratio_1", 1));
  CHECK(detail::is_named_after("box_minimum_z_m", "box_minimum_x_m", 2));
  CHECK_FALSE(detail::is_named_after("gear_ratio_3", "gear_ratio_1", 1));
  CHECK_FALSE(detail::is_named_after("gear_radio_2", "gear_ratio_1", 1));
  CHECK_FALSE(detail::is_named_after("gear_ratio_2_m", "gear_ratio_1", 1));
  CHECK_FALSE(detail::is_named_after("wall_stiffness_N_per_m", "wall_damping_Ns_per_m", 0));
}

TEST_CASE("the numbers of the protocol, which both ends of another version count on") {
  CHECK(std::string_view(reinterpret_cast<const char*>(&scope_magic), 4) == "IWSC");
  CHECK(static_cast<int>(ReportId::pose) == 1);
  CHECK(static_cast<int>(ReportId::command) == 2);
  CHECK(static_cast<int>(ReportId::information) == 16);
  CHECK(static_cast<int>(ReportId::parameters) == 17);
  CHECK(static_cast<int>(ReportId::transaction) == 18);
  CHECK(static_cast<int>(ReportId::store) == 25);
  CHECK(static_cast<int>(ReportId::stored) == 26);
  CHECK(static_cast<int>(Command::store_parameters) == 9);
  CHECK(static_cast<int>(Command::factory_reset) == 10);
  CHECK(static_cast<int>(ParameterOperation::restore_stored) == 2);
  CHECK(servo_rate_Hz == 20'000);
  CHECK(servo_period_s == 50e-6f);
  CHECK(std::int16_t{32'767} * current_step_A > 6.5f);
  CHECK(std::int16_t{32'767} * duty_step == 1.0f);
  CHECK(wire_size(SignalWire::float32) == 4);
  CHECK(wire_size(SignalWire::current_int16) == 2);
  CHECK(wire_size(SignalWire::duty_int16) == 2);
}

TEST_CASE("the reports have the specified field offsets and sizes") {
  CHECK(offsetof(PoseReport, fault) == 2);
  CHECK(offsetof(PoseReport, sequence) == 4);
  CHECK(offsetof(PoseReport, position_m) == 12);
  CHECK(offsetof(PoseReport, joint_rad) == 48);
  CHECK(offsetof(PoseReport, supply_dV) == 63);
  CHECK(offsetof(CommandReport, test) == 12);
  CHECK(offsetof(ParametersReport, entries) == 12);
  CHECK(offsetof(InformationReport, version) == 2);
  CHECK(offsetof(InformationReport, firmware_version) == 4);
  CHECK(offsetof(InformationReport, board) == 8);
  CHECK(offsetof(InformationReport, parameter_table_hash) == 40);
  CHECK(sizeof(ScopeFrameHeader) == 24);
  CHECK(offsetof(StoreReport, commands) == 8);
  CHECK(offsetof(StoreReport, sector_erases) == 16);
  CHECK(offsetof(StoreReport, unknown_ids) == 44);
}

TEST_CASE("board_name returns a terminated printable name, and an empty name otherwise") {
  char field[board_name_maximum + 1]{};
  CHECK(board_name(field).empty());
  const auto named = [&](std::string_view name) {
    std::ranges::fill(field, '\0');
    name.copy(field, sizeof field);
    return board_name(field);
  };
  constexpr std::string_view longest = "a_board_of_31_letters_1234567890";
  CHECK(named("omni_driver") == "omni_driver");
  CHECK(named(longest.substr(0, board_name_maximum)) == longest.substr(0, board_name_maximum));
  CHECK(named(longest).empty());
  CHECK(named("omni driver").empty());
  CHECK(named("omni\x1B[31m").empty());
  CHECK(named("omni\x7F").empty());
  CHECK(named("omni\xC4").empty());
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
