// The next action of the user, for each state in which the arm is not ready or the force is off.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host/companion/window/device_desk/device_desk.hpp"

namespace inkwell::window {

enum class NextAction : std::uint8_t { switch_force_on, into_inkwell, measure_motors, show_guides, show_log };

struct NextStep {
  std::string title;
  std::string reason;  ///< may be empty
  NextAction action;
  std::string button;
};

/// Properties of the window that decide about the next step.
struct NextStepSituation {
  bool has_hand = false;  ///< a simulated hand can move the stylus
  bool is_replay = false;
  std::string force_waits;  ///< a pane's reason why the force must stay off; empty: no reason
};

/// Returns the next step; empty while the force acts, during a replay, without a device, and in a fault. A fault has a
/// banner, and a missing device has a separate card.
std::optional<NextStep> next_step_of(const DeviceView& view, const NextStepSituation& situation);

/// Returns the reason why the force cannot be switched on, and the remedy; empty if nothing prevents the force.
std::string why_force_waits(const DeviceView& view, const NextStepSituation& situation);

}  // namespace inkwell::window
