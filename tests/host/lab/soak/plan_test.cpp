// Tests the random plans of a soak test: actions, valid transactions and invalid transactions.
#include "host/lab/soak/plan.hpp"
#include "host/lab/soak/storm.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include <doctest/doctest.h>

#include "firmware/store/parameter_check.hpp"

using namespace inkwell;
using namespace inkwell::soak;
using protocol::Parameter;
using protocol::ParameterSet;
using protocol::Refusal;

namespace {

/// Returns the firmware's decision about the changes.
link::ParameterCheck checked(const Changes& changes, const ParameterSet& now, bool force_is_on) {
  protocol::ParametersReport report{};
  report.report_id = protocol::ReportId::parameters;
  report.operation = protocol::ParameterOperation::set;
  report.version = protocol::protocol_version;
  report.count = static_cast<std::uint16_t>(changes.size());
  for (std::size_t i = 0; i < changes.size(); ++i)
    report.entries[i] = {info(changes[i].first).id, 0, changes[i].second};
  const auto bytes = std::as_bytes(std::span(&report, 1));
  return link::check_transaction(bytes.first(protocol::parameters_report_size(report.count)), now, force_is_on);
}

}  // namespace

TEST_CASE("every shuffled deck has each kind as often as the table states, in a different order") {
  Random random(1, 1);
  const auto deck = shuffled_deck(random), next = shuffled_deck(random);
  for (std::size_t i = 0; i < kind_table.size(); ++i) {
    CHECK(std::ranges::count(deck, static_cast<Kind>(i)) == static_cast<std::ptrdiff_t>(kind_table[i].cards));
    CHECK(kind_table[i].cards > 0);
  }
  CHECK(std::is_permutation(deck.begin(), deck.end(), next.begin(), next.end()));
  CHECK(deck != next);
}

TEST_CASE("the same seed and sitting produce the same numbers, and other seeds or sittings produce different numbers") {
  const auto first = [](std::uint64_t seed, std::uint64_t sitting) { return Random(seed, sitting).from(0, 1); };
  CHECK(first(1, 2) == first(1, 2));
  std::set<double> numbers;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (std::uint64_t sitting = 0; sitting < 20; ++sitting) numbers.insert(first(seed, sitting));
  CHECK(numbers.size() == 400);
  Random random(3, 3);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.from(-2, 5);
    CHECK((value >= -2 && value < 5));
    CHECK(random.below(7) < 7);
  }
}

TEST_CASE("the firmware accepts legal transactions in sequence, and also all parameters together") {
  for (const Reach reach : {Reach::careful, Reach::whole}) {
    Random random(5, 1);
    ParameterSet now = protocol::default_parameters();
    for (int i = 0; i < 2000; ++i) {
      const auto changes = legal_changes(random, now, reach, i % 10 == 0 ? 1000 : 1 + random.below(8));
      const auto check = checked(changes, now, reach == Reach::careful);
      REQUIRE(check.refusal == Refusal::accepted);
      now = with(now, changes);
      REQUIRE(check.set == now);
    }
  }
}

TEST_CASE("careful values stay within the range that is safe for a healthy arm") {
  Random random(6, 1);
  const ParameterSet defaults = protocol::default_parameters();
  for (int i = 0; i < 2000; ++i)
    for (const auto& [parameter, value] : legal_changes(random, defaults, Reach::careful, 5)) {
      CAPTURE(info(parameter).name);
      const Range range = range_of(parameter, Reach::careful);
      CHECK((value >= range.minimum && value <= range.maximum));
      CHECK_FALSE(info(parameter).needs_force_off);
      CHECK((range.minimum >= info(parameter).minimum && range.maximum <= info(parameter).maximum));
    }
}

TEST_CASE("illegal transactions are refused by the firmware for the reason that was meant; each reason comes") {
  for (const bool force_is_on : {false, true}) {
    Random random(7, force_is_on);
    ParameterSet now = protocol::default_parameters();
    std::set<Refusal> reasons;
    for (int i = 0; i < 3000; ++i) {
      const Illegal illegal = illegal_changes(random, now, force_is_on);
      REQUIRE(checked(illegal.changes, now, force_is_on).refusal == illegal.refusal);
      reasons.insert(illegal.refusal);
      if (i % 20 == 0)
        now = with(now, legal_changes(random, now, force_is_on ? Reach::careful : Reach::whole, 1 + random.below(5)));
    }
    CHECK(reasons.size() == (force_is_on ? 6 : 5));
  }
}
