#include <doctest/doctest.h>

#include <span>
#include <string_view>
#include <vector>

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "host/client/device/error.hpp"
#include "host/client/device/force_law.hpp"

namespace {

using namespace inkwell;

/// Returns the report of a device whose force law has one parameter and one signal.
std::vector<std::byte> report_of(std::string_view name) {
  std::vector<std::byte> report;
  const auto text = [&](std::string_view characters) {
    for (const char c : characters) report.push_back(static_cast<std::byte>(c));
    report.push_back({});
  };
  const auto number = [&](float value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    report.insert(report.end(), bytes.begin(), bytes.end());
  };
  report = {std::byte{0x15}, std::byte{1}, std::byte{1}, {}, {}, {}};
  text(name);
  text("For a test.");
  for (const float value : {-1.0f, 2.0f, 0.5f}) number(value);
  for (const std::string_view column : {"test_gain_N", "N", "A gain.", "test_depth_m", "m", "A depth."}) text(column);
  report[4] = static_cast<std::byte>(report.size());
  return report;
}

TEST_CASE("the description of a force law is taken apart") {
  const auto law = device::parse_force_law(report_of("test"));
  CHECK(law.name == "test");
  CHECK(law.help == "For a test.");
  REQUIRE(law.parameters.size() == 1);
  CHECK(law.parameters[0].id == protocol::force_law_first_id);
  CHECK(law.parameters[0].name == "test_gain_N");
  CHECK(law.parameters[0].unit == "N");
  CHECK(std::string(law.parameters[0].help) == "A gain.");
  CHECK(law.parameters[0].minimum == -1.0f);
  CHECK(law.parameters[0].maximum == 2.0f);
  CHECK(law.parameters[0].default_value == 0.5f);
  REQUIRE(law.signals.size() == 1);
  CHECK(law.signals[0].id == protocol::signal_count);
  CHECK(law.signals[0].name == "test_depth_m");
  CHECK(std::string(law.signals[0].help) == "A depth.");
}

TEST_CASE("the law of this image is described whole") {
  const auto& installed = control::installed_force_law;
  const auto law = device::parse_force_law(std::span(installed.report, installed.report_size));
  CHECK(law.name == "box");
  CHECK(!law.help.empty());
  CHECK(law.parameters.size() == installed.parameter_count);
  CHECK(law.signals.size() == installed.signal_count);
}

TEST_CASE("a description that ends too early, or counts more than there can be, is refused with a sentence") {
  const auto whole = report_of("test");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    auto cut = whole;
    cut.resize(size);
    CHECK_THROWS_AS(device::parse_force_law(cut), device::Error);
    if (size < 6) continue;
    cut[4] = static_cast<std::byte>(size);
    CHECK_THROWS_WITH_AS(device::parse_force_law(cut),
                         "The device's description of its force law is damaged. Build its firmware again and flash it.",
                         device::Error);
  }
  auto many = whole;
  many[1] = std::byte{protocol::force_law_parameters_maximum + 1};
  CHECK_THROWS_AS(device::parse_force_law(many), device::Error);
  many = whole;
  many[2] = std::byte{protocol::force_law_signals_maximum + 1};
  for (std::size_t i = 0; i < protocol::force_law_signals_maximum; ++i) many.insert(many.end(), 3, std::byte{});
  many[4] = static_cast<std::byte>(many.size() & 0xFF);
  many[5] = static_cast<std::byte>(many.size() >> 8);
  CHECK_THROWS_AS(device::parse_force_law(many), device::Error);
}

TEST_CASE("join_tables adds the rows of a law and refuses another law while the first law exists") {
  const std::size_t parameters = protocol::parameter_count, signals = protocol::signal_count;
  auto law = device::parse_force_law(report_of("first"));
  REQUIRE(device::join_tables(law));
  CHECK(protocol::known_parameters().size() == parameters + 1);
  CHECK(protocol::known_signals().size() == signals + 1);
  CHECK(static_cast<std::size_t>(*protocol::find_parameter("test_gain_N")) == parameters);
  CHECK(protocol::find_parameter(protocol::force_law_first_id) == protocol::find_parameter("test_gain_N"));
  CHECK(static_cast<std::size_t>(*protocol::find_signal("test_depth_m")) == signals);
  CHECK(protocol::default_parameters()[*protocol::find_parameter("test_gain_N")] == 0.5f);
  CHECK(device::joined_force_law() == "first");
  const auto same = device::parse_force_law(report_of("first"));
  CHECK(device::join_tables(same));
  const auto other = device::parse_force_law(report_of("other"));
  law = {};
  CHECK(!device::join_tables(other));  // `same` still exists
  CHECK(device::joined_force_law() == "first");
}

TEST_CASE("a range-based for loop over a table reaches the added rows") {
  const auto law = device::parse_force_law(report_of("first"));
  REQUIRE(device::join_tables(law));
  std::vector<std::string_view> signals, parameters;
  for (const auto& row : protocol::known_signals()) signals.push_back(row.name);
  for (const auto& row : protocol::known_parameters()) parameters.push_back(row.name);
  REQUIRE(signals.size() == protocol::signal_count + 1);
  CHECK(signals.back() == "test_depth_m");
  REQUIRE(parameters.size() == protocol::parameter_count + 1);
  CHECK(parameters.back() == "test_gain_N");
  const auto& bound = protocol::known_signals();
  CHECK(bound.size() == protocol::signal_count + 1);
}

TEST_CASE("a law replaces a law that no device uses") {
  const auto other = device::parse_force_law(report_of("other"));
  CHECK(device::join_tables(other));
  CHECK(device::joined_force_law() == "other");
}

TEST_CASE("a law without rows removes the rows of a law that is no longer in use") {
  const auto& installed = control::installed_force_law;
  CHECK(device::join_tables(device::parse_force_law(std::span(installed.report, installed.report_size))));
  CHECK(protocol::known_parameters().size() == protocol::parameter_count);
  CHECK(protocol::known_signals().size() == protocol::signal_count);
  CHECK(device::joined_force_law().empty());
}

}  // namespace
