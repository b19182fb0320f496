#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "firmware/store/parameter_store.hpp"

#include "tests/firmware/link/transaction.hpp"

namespace inkwell {

using link::ParameterStore;
using protocol::Parameter;
using protocol::Refusal;
using test::entry;
using test::Transaction;

namespace {

std::uint16_t id_of(Parameter parameter) { return protocol::info(parameter).id; }

/// Sends an invalid transaction. Checks the reason, the parameter and the value in the refusal. Checks that no
/// parameter has changed and that the interrupt receives no new settings.
void check_refused(ParameterStore& store, std::span<const std::byte> report, Refusal reason, std::uint16_t id = 0,
                   float value = 0.0f, bool force_is_on = false) {
  const protocol::ParameterSet before = store.values();
  const protocol::TransactionReport result_before = store.result();
  store.apply_offered(10);
  const control::Settings* settings = &store.settings();

  CHECK(store.accept(report, force_is_on) == reason);

  const protocol::TransactionReport result = store.result();
  CHECK(result.refusal == reason);
  CHECK(result.parameter_id == id);
  const float refused_value = result.value;
  if (std::isnan(value))
    CHECK(std::isnan(refused_value));
  else
    CHECK(refused_value == value);
  CHECK(result.transactions == result_before.transactions + 1);
  CHECK(store.values() == before);
  CHECK(!store.apply_offered(11));
  CHECK(&store.settings() == settings);
  CHECK(store.result().applied_at_periods == result_before.applied_at_periods);
}

}  // namespace

TEST_CASE("a store starts with the defaults and reads them in the table's order") {
  ParameterStore store;
  protocol::ParametersReport report = test::spoiled_report();
  CHECK(store.read(report) == protocol::parameters_report_size(protocol::parameter_count));
  CHECK(report.report_id == protocol::ReportId::parameters);
  CHECK(report.operation == protocol::ParameterOperation::set);
  CHECK(report.ticket == 0);
  CHECK(report.claim == 0);
  CHECK(report.version == protocol::protocol_version);
  REQUIRE(report.count == protocol::parameter_count);
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    CHECK(report.entries[i].id == protocol::parameter_table[i].id);
    const float value = report.entries[i].value;
    CHECK(value == protocol::parameter_table[i].default_value);
  }
}

TEST_CASE("an accepted transaction is applied as a whole, in the period in which the interrupt applies it") {
  ParameterStore store;
  CHECK(!store.apply_offered(0));
  const control::Settings* before = &store.settings();
  const float ramp_before = before->ramp_per_period;
  const Transaction transaction{entry(Parameter::wall_stiffness_N_per_m, 500.0f), entry(Parameter::force_ramp_s, 1.0f)};
  CHECK(store.accept(transaction.bytes(), false) == Refusal::accepted);
  CHECK(before->ramp_per_period == ramp_before);  // the current settings of the interrupt do not change

  CHECK(store.apply_offered(1234));
  const control::Settings& after = store.settings();
  CHECK(&after != before);
  protocol::ParameterSet expected = protocol::default_parameters();
  expected[Parameter::wall_stiffness_N_per_m] = 500.0f;
  expected[Parameter::force_ramp_s] = 1.0f;
  CHECK(after.ramp_per_period == control::prepare(expected).ramp_per_period);
  CHECK(after.ramp_per_period != ramp_before);
  CHECK(store.values() == expected);
  CHECK(store.result().applied_at_periods == 1234);
  CHECK(store.result().transactions == 1);

  CHECK(!store.apply_offered(1235));
  CHECK(&store.settings() == &after);
  CHECK(store.result().applied_at_periods == 1234);
}

TEST_CASE("a report that is padded is accepted, as Windows sends it") {
  for (const std::size_t size : {protocol::parameters_report_size(1) + 1, protocol::parameters_report_size(2),
                                 sizeof(protocol::ParametersReport) - 1, sizeof(protocol::ParametersReport)}) {
    ParameterStore store;
    const Transaction transaction{entry(Parameter::wall_damping_Ns_per_m, 3.0f)};
    CHECK(store.accept(transaction.bytes(size), false) == Refusal::accepted);
    CHECK(store.values()[Parameter::wall_damping_Ns_per_m] == 3.0f);
  }
}

TEST_CASE("defaults are restored by their operation, all of them") {
  ParameterStore store;
  const Transaction change{entry(Parameter::wall_stiffness_N_per_m, 1.0f), entry(Parameter::link_2_m, 0.2f)};
  REQUIRE(store.accept(change.bytes(), false) == Refusal::accepted);
  store.apply_offered(1);
  Transaction restore{};
  restore.report().operation = protocol::ParameterOperation::restore_defaults;

  SUBCASE("while the force is off") {
    CHECK(store.accept(restore.bytes(), false) == Refusal::accepted);
    CHECK(store.values() == protocol::default_parameters());
  }
  SUBCASE("but not while the force is on and the arm would change") {
    check_refused(store, restore.bytes(), Refusal::force_is_on, id_of(Parameter::link_2_m),
                  protocol::info(Parameter::link_2_m).default_value, true);
  }
  SUBCASE("and they come without entries") {
    restore.report().count = 1;
    check_refused(store, restore.bytes(), Refusal::wrong_length);
  }
}

TEST_CASE("each refusal reports its reason and leaves all parameters unchanged") {
  ParameterStore store;
  const std::uint16_t stiffness = id_of(Parameter::wall_stiffness_N_per_m);
  const float infinity = std::numeric_limits<float>::infinity();
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  // A valid entry before the invalid entry must have no effect.
  const protocol::ParameterEntry good = entry(Parameter::wall_damping_Ns_per_m, 5.0f);

  SUBCASE("wrong version") {
    Transaction transaction{good};
    transaction.report().version = protocol::protocol_version + 1;
    check_refused(store, transaction.bytes(), Refusal::wrong_version);
  }
  SUBCASE("wrong length") {
    const Transaction transaction{good, good};
    const std::size_t right = protocol::parameters_report_size(2);
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{8}, right - 8, right - 1})
      check_refused(store, transaction.bytes(size), Refusal::wrong_length);
  }
  SUBCASE("more entries than a report holds") {
    Transaction transaction{good};
    transaction.report().count = protocol::parameter_entries_maximum + 1;
    check_refused(store, transaction.bytes(sizeof(protocol::ParametersReport)), Refusal::wrong_length);
    transaction.report().count = 0xFFFF;
    check_refused(store, transaction.bytes(sizeof(protocol::ParametersReport)), Refusal::wrong_length);
  }
  SUBCASE("unknown operation") {
    Transaction transaction{good};
    transaction.report().operation = static_cast<protocol::ParameterOperation>(3);
    check_refused(store, transaction.bytes(), Refusal::unknown_operation);
  }
  SUBCASE("a restore without stored parameters is refused") {
    Transaction transaction{};
    transaction.report().operation = protocol::ParameterOperation::restore_stored;
    check_refused(store, transaction.bytes(), Refusal::nothing_stored);
  }
  SUBCASE("unknown parameter") {
    for (const std::uint16_t id : {0, 99, 106, 609, 0xFFFF})
      check_refused(store, Transaction{good, {id, 0, 1.0f}}.bytes(), Refusal::unknown_parameter, id, 1.0f);
  }
  SUBCASE("not finite") {
    for (const float value : {infinity, -infinity, not_a_number})
      check_refused(store, Transaction{good, {stiffness, 0, value}}.bytes(), Refusal::not_finite, stiffness, value);
  }
  SUBCASE("out of range") {
    const float above = std::nextafter(3000.0f, infinity);
    for (const float value : {-1.0f, above, 1e30f})
      check_refused(store, Transaction{good, {stiffness, 0, value}}.bytes(), Refusal::out_of_range, stiffness, value);
  }
  SUBCASE("not whole") {
    const Parameter counts = Parameter::encoder_1_counts_per_turn;
    check_refused(store, Transaction{good, entry(counts, 1440.5f)}.bytes(), Refusal::not_whole, id_of(counts), 1440.5f);
    const Parameter choice = Parameter::transmission;
    check_refused(store, Transaction{good, entry(choice, 0.5f)}.bytes(), Refusal::not_whole, id_of(choice), 0.5f);
  }
  SUBCASE("given twice") {
    check_refused(store, Transaction{good, {stiffness, 0, 1.0f}, {stiffness, 0, 2.0f}}.bytes(), Refusal::given_twice,
                  stiffness, 2.0f);
  }
  SUBCASE("busy until the interrupt has taken the one before") {
    REQUIRE(store.accept(Transaction{good}.bytes(), false) == Refusal::accepted);
    const protocol::ParameterSet accepted = store.values();
    CHECK(store.accept(Transaction{{stiffness, 0, 1.0f}}.bytes(), false) == Refusal::busy);
    CHECK(store.result().refusal == Refusal::busy);
    CHECK(store.values() == accepted);
    store.apply_offered(5);
    CHECK(store.accept(Transaction{{stiffness, 0, 1.0f}}.bytes(), false) == Refusal::accepted);
  }
}

TEST_CASE("bounds must leave room between them") {
  ParameterStore store;
  const struct {
    Parameter minimum, maximum;
  } pairs[] = {
      {Parameter::box_minimum_x_m, Parameter::box_maximum_x_m},
      {Parameter::box_minimum_y_m, Parameter::box_maximum_y_m},
      {Parameter::box_minimum_z_m, Parameter::box_maximum_z_m},
      {Parameter::joint_1_minimum_rad, Parameter::joint_1_maximum_rad},
      {Parameter::joint_2_minimum_rad, Parameter::joint_2_maximum_rad},
      {Parameter::elbow_minimum_rad, Parameter::elbow_maximum_rad},
  };
  for (const auto& pair : pairs) {
    CAPTURE(protocol::info(pair.minimum).name);
    check_refused(store, Transaction{entry(pair.minimum, 0.3f), entry(pair.maximum, 0.3f)}.bytes(),
                  Refusal::inconsistent, id_of(pair.minimum), 0.3f);
    check_refused(store, Transaction{entry(pair.maximum, -0.4f), entry(pair.minimum, 0.4f)}.bytes(),
                  Refusal::inconsistent, id_of(pair.minimum), 0.4f);
  }
  // The check of both bounds does not depend on their order in the transaction.
  const Transaction both{entry(Parameter::box_minimum_x_m, 0.2f), entry(Parameter::box_maximum_x_m, 0.4f)};
  CHECK(store.accept(both.bytes(), false) == Refusal::accepted);
}

TEST_CASE("the box must have room for the sphere") {
  ParameterStore store;
  const float radius_m = protocol::info(Parameter::sphere_radius_m).default_value;
  const Transaction narrow{entry(Parameter::box_minimum_y_m, 0.0f), entry(Parameter::box_maximum_y_m, 1.9f * radius_m)};
  check_refused(store, narrow.bytes(), Refusal::inconsistent, id_of(Parameter::box_minimum_y_m), 0.0f);

  const Transaction wide{entry(Parameter::box_minimum_y_m, 0.0f), entry(Parameter::box_maximum_y_m, 2.1f * radius_m)};
  REQUIRE(store.accept(wide.bytes(), false) == Refusal::accepted);
  store.apply_offered(1);
  check_refused(store, Transaction{entry(Parameter::sphere_radius_m, 1.1f * radius_m)}.bytes(), Refusal::inconsistent,
                id_of(Parameter::sphere_radius_m), 1.1f * radius_m);
  check_refused(store, Transaction{entry(Parameter::box_maximum_y_m, 1.9f * radius_m)}.bytes(), Refusal::inconsistent,
                id_of(Parameter::box_maximum_y_m), 1.9f * radius_m);
}

TEST_CASE("while the force is on, only the parameters of the arm cannot change") {
  ParameterStore store;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i) {
    const protocol::ParameterInfo& row = protocol::parameter_table[i];
    CAPTURE(row.name);
    const bool arm = row.group == "arm";
    // While the force is on, a parameter may be set to its current value.
    CHECK(store.accept(Transaction{{row.id, 0, row.default_value}}.bytes(), true) == Refusal::accepted);
    store.apply_offered(0);
    if (!arm) continue;
    const float other = row.default_value == row.maximum ? row.minimum : row.maximum;
    check_refused(store, Transaction{{row.id, 0, other}}.bytes(), Refusal::force_is_on, row.id, other, true);
  }
  CHECK(store.accept(Transaction{entry(Parameter::wall_stiffness_N_per_m, 100.0f)}.bytes(), true) == Refusal::accepted);
}

TEST_CASE("a bit of the settings that changes by itself is found, whichever it is, and new settings are not it") {
  ParameterStore store;
  CHECK(store.settings_are_intact());
  const Transaction transaction{entry(Parameter::wall_stiffness_N_per_m, 700.0f)};
  REQUIRE(store.accept(transaction.bytes(), false) == Refusal::accepted);
  CHECK(store.settings_are_intact());  // the interrupt has not accepted the settings yet
  store.apply_offered(1);
  CHECK(store.settings_are_intact());
  auto* bytes = reinterpret_cast<unsigned char*>(const_cast<control::Settings*>(&store.settings()));
  for (std::size_t i = 0; i < sizeof(control::Settings); i += 7) {
    bytes[i] ^= 0x10;
    CHECK_FALSE(store.settings_are_intact());
    bytes[i] ^= 0x10;
  }
  CHECK(store.settings_are_intact());
}

TEST_CASE("a bit of the values that changes by itself is found, whichever it is") {
  ParameterStore store;
  REQUIRE(store.accept(Transaction{entry(Parameter::force_limit_N, 1.5f)}.bytes(), false) == Refusal::accepted);
  CHECK(store.values_are_intact());
  for (const float& value : store.values().values) {
    test::flip_bit(value);
    CHECK_FALSE(store.values_are_intact());
    CHECK_FALSE(store.guarded_values().is_intact());
    test::flip_bit(value);
  }
  CHECK(store.values_are_intact());
}

TEST_CASE("nothing is made of damaged values, and nothing hides them, be it a transaction or the defaults") {
  ParameterStore store;
  REQUIRE(store.accept(Transaction{entry(Parameter::force_limit_N, 1.5f)}.bytes(), false) == Refusal::accepted);
  store.apply_offered(1);
  Transaction transaction{entry(Parameter::force_limit_N, 1.0f)};
  SUBCASE("one value, which may be the damaged one") {}
  SUBCASE("all of them") {
    transaction = Transaction{};
    transaction.report().operation = protocol::ParameterOperation::restore_defaults;
  }
  const float& force_limit_N = store.values().values[static_cast<std::size_t>(Parameter::force_limit_N)];
  test::flip_bit(force_limit_N);
  check_refused(store, transaction.bytes(), Refusal::busy);
  CHECK_FALSE(store.restore_defaults());
  CHECK(!store.apply_offered(2));
  CHECK_FALSE(store.values_are_intact());
  test::flip_bit(force_limit_N);
  CHECK(store.accept(transaction.bytes(), false) == Refusal::accepted);
}

TEST_CASE("stored parameters are restored unless one of their bits has flipped") {
  ParameterStore store;
  protocol::ParameterSet set = protocol::default_parameters();
  set[Parameter::force_limit_N] = 1.5f;
  const link::Guarded stored(set);
  Transaction restore{};
  restore.report().operation = protocol::ParameterOperation::restore_stored;
  test::flip_bit(stored.value().values[3]);
  const protocol::ParameterSet before = store.values();
  CHECK(store.accept(restore.bytes(), false, &stored) == Refusal::busy);
  CHECK(store.values() == before);
  CHECK(!store.apply_offered(1));
  test::flip_bit(stored.value().values[3]);
  CHECK(store.accept(restore.bytes(), false, &stored) == Refusal::accepted);
  CHECK(store.values() == set);
}

}  // namespace inkwell
