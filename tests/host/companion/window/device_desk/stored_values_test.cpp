// Tests the window's messages about the stored parameters, and the conditions for storing parameters.
#include <doctest/doctest.h>

#include "host/companion/window/device_desk/stored_values.hpp"

using namespace inkwell;
using protocol::Parameter;
using protocol::State;

namespace {

window::DeviceView connected(State state) {
  window::DeviceView view;
  view.status.connection = device::Connection::connected;
  view.parameters = protocol::default_parameters();
  view.status.store = device::BoardStore{{}, *view.parameters};
  view.status.store->report.stores_left = 10;
  view.pose = device::Pose{};
  view.pose->state = state;
  return view;
}

}  // namespace

TEST_CASE("stored_title states in words how many values are not stored") {
  CHECK(window::stored_title({}).empty());
  CHECK(window::not_stored({}).empty());
  auto view = connected(State::ready);
  CHECK(window::stored_title(view) == "All values are defaults");
  view.status.store->report.contents = protocol::StoreContents::parameters;
  CHECK(window::stored_title(view) == "All values are stored");
  (*view.parameters)[Parameter::force_limit_N] = 1.0f;
  CHECK(window::stored_title(view) == "1 value is not stored");
  (*view.parameters)[Parameter::link_2_m] = 0.2f;
  CHECK(window::stored_title(view) == "2 values are not stored");
  CHECK(window::not_stored(view) == std::vector{Parameter::force_limit_N, Parameter::link_2_m});
}

TEST_CASE("why_storing_waits returns the reason why the board would refuse to store") {
  const auto remedy = [](protocol::StoreResult result) { return std::string(info(result).remedy); };
  CHECK_FALSE(window::why_storing_waits({}).empty());
  for (const auto state : {State::unreferenced, State::ready, State::fault})
    CHECK(window::why_storing_waits(connected(state)).empty());
  for (const auto state : {State::active, State::ramping, State::limited})
    CHECK(window::why_storing_waits(connected(state)) == remedy(protocol::StoreResult::force_is_on));
  auto view = connected(State::ready);
  view.status.store->report.stores_left = 0;
  CHECK(window::why_storing_waits(view) == remedy(protocol::StoreResult::no_room));
  view.status.is_storing = true;
  CHECK(window::why_storing_waits(view) != remedy(protocol::StoreResult::no_room));
  CHECK_FALSE(window::why_storing_waits(view).empty());
}
