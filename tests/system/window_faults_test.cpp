// Operates the fault injection pane in the same way as a user.
#include <doctest/doctest.h>

#include <csignal>
#include <string>

#include "tests/system/window_rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

void open_pane(WindowRig& rig) { rig.click("tabs/Faults"); }

void look_for(WindowRig& rig, const std::string& text) {
  rig.wait_until("it says " + text, [&](const Sight& now) { return now.says(text); });
}

/// Text that is typed before the field has the keyboard focus is lost.
void wait_for_keyboard(WindowRig& rig, const std::string& field) {
  rig.wait_until(field + " has the keyboard", [&](const Sight& now) { return now.is_active(field); });
}

/// Returns the name of the control with the keyboard focus, or an empty string.
std::string focused_control(const Sight& sight) {
  for (const auto& each : sight.all.at("items").items())
    if (each.value().at("active")) return each.key();
  return sight.with_keyboard();
}

/// In ImGui 1.90, the Tab key selects the buttons before the text field.
void go_by_tab(WindowRig& rig, const std::string& field) {
  constexpr int most_stops = 5;
  for (int stop = 0; stop < most_stops && !rig.look().is_active(field); ++stop) {
    const std::string before = focused_control(rig.look());
    rig.type("\t");  // in one event, because a held Tab key repeats
    rig.wait_until("Tab leaves " + before, [&](const Sight& now) { return focused_control(now) != before; });
  }
  wait_for_keyboard(rig, field);
}

/// ImGui generates the name of a popup list.
void click_in_list(WindowRig& rig, const std::string& name) {
  std::string item;
  rig.wait_until(name + " is in the list", [&](const Sight& now) {
    for (const auto& each : now.all.at("items").items())
      if (each.key().starts_with("##Popup") && each.key().ends_with("/" + name)) item = each.key();
    return !item.empty();
  });
  rig.click(item);
}

std::size_t count_in(WindowRig& rig) { return rig.control.status().all.at("injected").size(); }

}  // namespace

TEST_CASE("a fault is chosen in the table, injected, shown with the reported fault, and healed") {
  WindowRig rig;
  open_pane(rig);
  CHECK(rig.look().says("SIMULATION"));
  rig.click("faults/Supply");
  rig.click("faults/supply_sag");
  CHECK(rig.look().says("Voltage to which the bridge supply falls."));
  CHECK(rig.look().says("0 to 18"));
  rig.enter("faults/amount", "6");
  rig.click("faults/Inject");
  look_for(rig, "6 V, active since");
  look_for(rig, "Reported fault: Supply low, after ");
  CHECK(rig.look().state() == "fault");
  const auto injected = rig.control.status().all.at("injected");
  REQUIRE(injected.size() == 1);
  CHECK(injected[0].at("fault") == "supply_sag");
  CHECK(injected[0].at("amount") == 6.0);
  rig.click("faults/Heal supply_sag");
  look_for(rig, "over");
  CHECK(count_in(rig) == 0);
  CHECK(rig.look().says("Reported fault: Supply low"));
  CHECK_FALSE(rig.look().can_click("faults/Heal all"));
}

TEST_CASE("without a control port no faults can be injected, and the pane states the reason") {
  WindowRig rig({"--flat-colours"}, false);
  rig.press_key("F7");  // no such tab
  CHECK(rig.look().has("tuning/wall_stiffness_N_per_m"));
  rig.press_key("F5");
  look_for(rig, "control port of this virtual board is unknown");
  CHECK_FALSE(rig.look().has("faults/search"));
  rig.press_key("ctrl+Delete");
  CHECK_FALSE(rig.look().says("SIMULATION"));
}

TEST_CASE("the pane is worked by the keyboard alone") {
  WindowRig rig;
  rig.press_key("F5");
  wait_for_keyboard(rig, "faults/search");
  rig.type("slip");
  rig.press_key("Down");
  rig.press_key("Return");
  wait_for_keyboard(rig, "faults/location");
  rig.type("3");
  go_by_tab(rig, "faults/amount");
  rig.type("-250");
  rig.press_key("Return");
  look_for(rig, "motor 3, -250 counts");
  const auto injected = rig.control.status().all.at("injected");
  REQUIRE(injected.size() == 1);
  CHECK(injected[0].at("of") == "3");
  rig.press_key("ctrl+Delete");
  look_for(rig, "over");
  CHECK(count_in(rig) == 0);
}

TEST_CASE("a fault without a location cannot be injected, and a refusal or an invalid number is a sentence") {
  WindowRig rig;
  open_pane(rig);
  rig.enter("faults/search", "motor hot");
  rig.click("faults/motor_hot");
  rig.wait_until("the form is there", [](const Sight& now) { return now.has("faults/Inject"); });
  CHECK_FALSE(rig.look().can_click("faults/Inject"));
  rig.click("tabs/Faults");  // leaves the search field, because no tooltip covers the fields during typing
  rig.move_to(rig.look().item("faults/Inject").centre());
  look_for(rig, "Choose a motor first.");
  rig.click("faults/2");
  rig.enter("faults/amount", "1,5");
  rig.click("faults/Inject");
  look_for(rig, "`1,5` is not a number");
  rig.enter("faults/amount", "400");
  rig.click("faults/Inject");
  look_for(rig, "Motor hot 400 K is outside 0 to 300");
  CHECK(count_in(rig) == 0);
  rig.enter("faults/amount", "40");
  rig.click("faults/Inject");
  look_for(rig, "motor 2, 40 K, active since");
  CHECK_FALSE(rig.look().says("is outside"));
}

TEST_CASE("the pane shows the planned, active and healed faults of another program") {
  WindowRig rig;
  open_pane(rig);
  rig.control.pause();
  rig.control.inject({.fault = "wire_low", .of = "button_1", .after_s = 0.5});
  look_for(rig, "button_1, starts at");
  rig.control.run(0.6);
  look_for(rig, "button_1, active since");
  look_for(rig, "No fault reported");
  rig.control.heal_all();
  look_for(rig, "over");
}

TEST_CASE("the same fault again replaces the first, and outlasts a reset") {
  WindowRig rig;
  open_pane(rig);
  rig.enter("faults/search", "motor_hot");
  rig.click("faults/motor_hot");
  rig.click("faults/2");
  for (const std::string amount : {"40", "50"}) {
    rig.enter("faults/amount", amount);
    rig.click("faults/Inject");
    look_for(rig, "motor 2, " + amount + " K, active since");
  }
  look_for(rig, "motor 2, 40 K, started at");
  CHECK(count_in(rig) == 1);
  rig.control.reset();
  rig.wait_until("the device is gone", [](const Sight& now) { return !now.connected(); });
  rig.wait_until("it is back", [](const Sight& now) { return now.connected(); });
  CHECK(rig.look().says("motor 2, 50 K, active since"));
  rig.click("faults/Heal all");
  look_for(rig, "motor 2, 50 K, started at");
  CHECK(count_in(rig) == 0);
}

TEST_CASE("a wire is chosen from the board's, two of them one after the other") {
  WindowRig rig;
  open_pane(rig);
  rig.enter("faults/search", "shorted wires averaged");
  rig.click("faults/wires_shorted");
  for (const char* wire : {"encoders[0].a", "encoders[0].b"}) {
    rig.click("faults/wires");
    click_in_list(rig, wire);
  }
  rig.click("faults/Inject");
  look_for(rig, "encoders[0].a+encoders[0].b, active since");
}

TEST_CASE("the faults pane reports an unplugged device or a missing board") {
  WindowRig rig;
  open_pane(rig);
  rig.enter("faults/search", "usb_cut");
  rig.click("faults/usb_cut");
  rig.click("faults/Inject");
  rig.wait_until("the device is gone", [](const Sight& now) { return !now.connected(); });
  rig.click("faults/Heal usb_cut");
  rig.wait_until("it is back", [](const Sight& now) { return now.connected(); });
  rig.control.quit();
  look_for(rig, "The virtual board does not answer.");
  CHECK_FALSE(rig.look().can_click("faults/Inject"));
}
