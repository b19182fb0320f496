#include "host/companion/window/device_desk/next_step.hpp"

namespace inkwell::window {

using protocol::State;

namespace {

NextStep for_unreferenced(bool has_hand) {
  if (has_hand)
    return {"Position unknown: put the stylus into the inkwell",
            "The inkwell is the reference position of the encoders. The simulated hand can move the stylus.",
            NextAction::into_inkwell, "Into the inkwell"};
  return {"Position unknown: put the stylus into the inkwell",
          "The inkwell is the reference position of the encoders. If the stylus is in the inkwell, take it out first.",
          NextAction::show_guides, "Show guides"};
}

std::optional<NextStep> for_missing_motors(const device::Pose& pose) {
  if (!protocol::force_is_on(pose.state) || !protocol::is_reached(pose.limits, protocol::Limit::motors))
    return std::nullopt;
  return NextStep{"No motor receives current: a motor is missing or unknown",
                  "Connect all motors. The guide measures the motors, and then proposes to confirm them.",
                  NextAction::measure_motors, "Measure motors"};
}

}  // namespace

std::optional<NextStep> next_step_of(const DeviceView& view, const NextStepSituation& situation) {
  if (!view.pose || situation.is_replay) return std::nullopt;
  switch (view.state()) {
    case State::ready:
      if (!situation.force_waits.empty()) return std::nullopt;
      return NextStep{"The force is off: walls do not push back.", "", NextAction::switch_force_on, "Switch force on"};
    case State::unreferenced: return for_unreferenced(situation.has_hand);
    case State::starting:
      return NextStep{"The board starts: wait a moment", std::string(protocol::info(State::starting).meaning),
                      NextAction::show_log, "Show log"};
    case State::testing:
      return NextStep{"Self-test: hold the arm still",
                      "Short pulses on the motors check the bridges and sensors. The test ends automatically.",
                      NextAction::show_log, "Show log"};
    case State::update:
      return NextStep{"The board starts its boot loader",
                      "The motors are off. The window offers the firmware when the boot loader runs.",
                      NextAction::show_log, "Show log"};
    default: return for_missing_motors(*view.pose);
  }
}

std::string why_force_waits(const DeviceView& view, const NextStepSituation& situation) {
  if (situation.is_replay) return "Close the replay first. The window shows a recording instead of the arm.";
  if (!view.pose) return "No device is connected. Plug in a device.";
  if (!situation.force_waits.empty()) return situation.force_waits;
  switch (view.state()) {
    case State::unreferenced:
    case State::starting:
    case State::testing:
    case State::update: {
      const NextStep step = *next_step_of(view, situation);
      return step.title + ". " + step.reason;
    }
    case State::fault: return "A fault keeps the force off. Read the banner, and clear the fault first.";
    default: return {};
  }
}

}  // namespace inkwell::window
