// Tests the notice about changed values after a reconnection, and the restoration of these values.
#include <doctest/doctest.h>

#include "host/companion/window/device_desk/returned_values.hpp"

using namespace inkwell;
using protocol::Parameter;
using window::ReturnedValues;

namespace {

constexpr Parameter stiffness = Parameter::wall_stiffness_N_per_m;
constexpr Parameter damping = Parameter::wall_damping_Ns_per_m;

/// The device had the values `held_before` before a reconnection and has default values afterward.
window::DeviceView returned(std::initializer_list<device::ParameterChange> held_before) {
  window::DeviceView view;
  view.status.connection = device::Connection::connected;
  view.parameters = protocol::default_parameters();
  view.reconnection = {.number = 1, .before = *view.parameters, .after = *view.parameters};
  for (const auto& [parameter, value] : held_before) view.reconnection->before[parameter] = value;
  return view;
}

window::DeviceView set(window::DeviceView view, Parameter parameter, float value) {
  (*view.parameters)[parameter] = value;
  return view;
}

}  // namespace

TEST_CASE("no message is shown before the first reconnection or while the device is disconnected") {
  ReturnedValues values;
  values.follow({}, 0.0);
  CHECK_FALSE(values.is_shown());
  values.follow(returned({{stiffness, 1500.0f}}), 1.0);
  CHECK(values.is_shown());
  values.follow({}, 2.0);
  CHECK_FALSE(values.is_shown());
}

TEST_CASE("the message that all values are unchanged is shown for six seconds") {
  ReturnedValues values;
  const auto view = returned({});
  values.follow(view, 10.0);
  CHECK(values.is_shown());
  CHECK_FALSE(values.waits_for_user());
  CHECK(values.rows().empty());
  values.follow(view, 15.9);
  CHECK(values.is_shown());
  values.follow(view, 16.1);
  CHECK_FALSE(values.is_shown());
}

TEST_CASE("changed values are shown with their previous values until the user dismisses the list") {
  ReturnedValues values;
  const auto view = returned({{stiffness, 1500.0f}, {damping, 3.0f}});
  values.follow(view, 0.0);
  values.follow(view, 1000.0);
  REQUIRE(values.is_shown());
  CHECK(values.waits_for_user());
  REQUIRE(values.rows().size() == 2);
  CHECK(values.rows()[0].parameter == stiffness);
  CHECK(values.rows()[0].before == 1500.0f);
  CHECK(values.rows()[0].now == protocol::info(stiffness).default_value);
  CHECK(values.changes_back() == std::vector<device::ParameterChange>{{stiffness, 1500.0f}, {damping, 3.0f}});
  values.dismiss();
  values.follow(view, 1001.0);
  CHECK_FALSE(values.is_shown());
  CHECK_FALSE(values.waits_for_user());
}

TEST_CASE("a value that was changed after the reconnection is no longer listed") {
  ReturnedValues values;
  const auto view = returned({{stiffness, 1500.0f}, {damping, 3.0f}});
  values.follow(view, 0.0);
  const auto one_set = set(view, stiffness, 400.0f);
  values.follow(one_set, 1.0);
  CHECK(values.is_shown());
  CHECK(values.changes_back() == std::vector<device::ParameterChange>{{damping, 3.0f}});
  values.follow(set(one_set, damping, 3.0f), 2.0);
  CHECK_FALSE(values.is_shown());
}

TEST_CASE("each reconnection shows the changed values again") {
  ReturnedValues values;
  auto view = returned({{stiffness, 1500.0f}});
  values.follow(view, 0.0);
  values.dismiss();
  view.reconnection->number = 2;
  view.reconnection->before[damping] = 3.0f;
  values.follow(view, 1.0);
  CHECK(values.is_shown());
  CHECK(values.rows().size() == 2);
}
