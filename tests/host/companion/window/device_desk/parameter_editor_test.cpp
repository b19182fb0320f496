// Tests the values of the sliders: the device's values, pending edits, undo, redo and refusals.
#include <algorithm>

#include <doctest/doctest.h>

#include "host/companion/window/device_desk/parameter_editor.hpp"

using namespace inkwell;
using device::ParameterChange;
using protocol::Parameter;
using window::ParameterEditor;

namespace {

constexpr Parameter stiffness = Parameter::wall_stiffness_N_per_m;
constexpr Parameter damping = Parameter::wall_damping_Ns_per_m;

// This device accepts every change.
struct AgreeableDevice {
  protocol::ParameterSet held = protocol::default_parameters();

  void exchange(ParameterEditor& editor) {
    for (const auto& [parameter, value] : editor.take_changes()) held[parameter] = value;
    editor.device_holds(held);
  }
};

void set(ParameterEditor& editor, Parameter parameter, float value, double now_s = 0.0) {
  const ParameterChange change{parameter, value};
  editor.apply("test", {&change, 1}, now_s);
}

}  // namespace

TEST_CASE("without a device nothing can be edited") {
  ParameterEditor editor;
  set(editor, stiffness, 100.0f);
  CHECK_FALSE(editor.known());
  CHECK(editor.take_changes().empty());
  CHECK_FALSE(editor.can_undo());
}

TEST_CASE("an edit is shown immediately, is sent once, and is replaced by the value of the device") {
  ParameterEditor editor;
  AgreeableDevice device;
  device.exchange(editor);
  set(editor, stiffness, 100.0f);
  CHECK(editor.shown(stiffness) == 100.0f);
  CHECK(editor.differs_from_default(stiffness));
  const auto changes = editor.take_changes();
  REQUIRE(changes.size() == 1);
  CHECK(changes[0] == ParameterChange{stiffness, 100.0f});
  CHECK(editor.take_changes().empty());
  // The device first answers with the values of another transaction. The window shows an unconfirmed edit for at most
  // one second.
  editor.device_holds(device.held);
  CHECK(editor.shown(stiffness) == 100.0f);
  editor.forget_unconfirmed(0.9);
  CHECK(editor.shown(stiffness) == 100.0f);
  editor.forget_unconfirmed(1.1);
  CHECK(editor.shown(stiffness) == 800.0f);
}

TEST_CASE("a slider that is dragged makes one transaction a frame and one undo step") {
  ParameterEditor editor;
  AgreeableDevice device;
  device.exchange(editor);
  editor.begin_step("Wall stiffness");
  for (float value : {700.0f, 600.0f, 500.0f}) {
    const ParameterChange change{stiffness, value};
    editor.edit({&change, 1}, 0.0);
  }
  CHECK(editor.take_changes() == std::vector<ParameterChange>{{stiffness, 500.0f}});
  editor.end_step();
  CHECK(editor.undo_title() == "Wall stiffness");
  editor.undo(0.0);
  CHECK(editor.take_changes() == std::vector<ParameterChange>{{stiffness, 800.0f}});
  CHECK_FALSE(editor.can_undo());
  editor.redo(0.0);
  CHECK(editor.shown(stiffness) == 500.0f);
  CHECK_FALSE(editor.can_redo());
}

TEST_CASE("a drag that returns to its start is not an undo step") {
  ParameterEditor editor;
  AgreeableDevice device;
  device.exchange(editor);
  editor.begin_step("Wall stiffness");
  for (float value : {700.0f, 800.0f}) {
    const ParameterChange change{stiffness, value};
    editor.edit({&change, 1}, 0.0);
  }
  editor.end_step();
  CHECK_FALSE(editor.can_undo());
}

TEST_CASE("a new edit after an undo discards the undone edit") {
  ParameterEditor editor;
  AgreeableDevice device;
  device.exchange(editor);
  set(editor, stiffness, 100.0f);
  set(editor, damping, 5.0f);
  editor.undo(0.0);
  CHECK(editor.can_redo());
  set(editor, stiffness, 200.0f);
  CHECK_FALSE(editor.can_redo());
  editor.undo(0.0);
  CHECK(editor.shown(stiffness) == 100.0f);
  CHECK(editor.shown(damping) == 2.0f);
}

TEST_CASE("a refusal brings the old values back, and its step is not in the history") {
  ParameterEditor editor;
  AgreeableDevice device;
  device.exchange(editor);
  set(editor, damping, 5.0f);
  device.exchange(editor);
  set(editor, Parameter::link_2_m, 0.2f);
  editor.take_changes();
  editor.refused();
  CHECK(editor.shown(Parameter::link_2_m) == protocol::info(Parameter::link_2_m).default_value);
  REQUIRE(editor.can_undo());
  editor.undo(0.0);
  CHECK(editor.shown(damping) == 2.0f);
  CHECK_FALSE(editor.can_undo());
}

TEST_CASE("labels are words without group and unit") {
  CHECK(window::label_of(protocol::info(stiffness)) == "Wall stiffness");
  CHECK(window::label_of(protocol::info(Parameter::box_minimum_x_m)) == "Minimum x");
  CHECK(window::label_of(protocol::info(Parameter::current_integral_gain_V_per_As)) == "Integral gain");
  CHECK(window::label_of(protocol::info(Parameter::current_limit_1_A)) == "Current limit 1");
  CHECK(window::label_of(protocol::info(Parameter::torque_constant_2_Nm_per_A)) == "Torque constant 2");
  CHECK(window::label_of(protocol::info(Parameter::gimbal_1_slope_rad)) == "Gimbal 1 slope");
  CHECK(window::label_of(protocol::info(Parameter::program_force_change_N_per_s)) == "Force change");
  CHECK(window::label_of(protocol::info(Parameter::transmission)) == "Transmission");
  CHECK(window::label_of(protocol::info(Parameter::encoder_1_counts_per_turn)) == "Encoder 1 counts per turn");
}

TEST_CASE("where no heading names the group, the label does") {
  CHECK(window::full_label_of(protocol::info(Parameter::box_minimum_x_m)) == "Box minimum x");
  CHECK(window::full_label_of(protocol::info(Parameter::current_limit_1_A)) == "Current limit 1");
  CHECK(window::full_label_of(protocol::info(stiffness)) == "Wall stiffness");
}

TEST_CASE("every preset lies in its parameters' ranges") {
  REQUIRE(window::presets().size() == 3);
  for (const window::Preset& preset : window::presets())
    for (const auto& [parameter, value] : preset.changes) {
      const auto& info = protocol::info(parameter);
      CAPTURE(info.name);
      CHECK(value >= info.minimum);
      CHECK(value <= info.maximum);
      CHECK(value != info.default_value);
    }
}
