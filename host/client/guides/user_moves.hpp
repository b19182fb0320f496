// Common steps of the calibration guides.
#pragma once

#include <array>
#include <string>

#include "host/client/guides/step.hpp"

#include "host/client/guides/joint_motion.hpp"

namespace inkwell::guides {

using Angles = std::array<double, 3>;

/// A parameter of one of three joints or axes, counted from 1.
inline double value(const protocol::ParameterSet& set, protocol::EachAxis<protocol::Parameter> rows, int number) {
  return static_cast<double>(set[of_number(rows, number)]);
}

/// The user moves the arm or the stylus, then confirms with Confirm or button 1.
class UserMoves : public Step {
 public:
  void begin(const Observation& now, DevicePort&) override { since_.start(*now.pose); }
  bool takes_confirmation() const override { return true; }
  void confirm() override { confirmed_ = true; }

  bool advance(const Observation& now, DevicePort&) override {
    const bool pressed = is_closed(now.pose->switches, protocol::Switch::button_1);
    if (pressed && !was_pressed_) confirmed_ = true;
    was_pressed_ = pressed;
    if (since_.seconds(*now.pose) > user_limit_s) throw device::Error(too_late());
    observe(now, since_.seconds(*now.pose));
    if (!confirmed_) return false;
    confirmed_ = false;
    if (!is_complete()) return false;
    take(now);
    return true;
  }

 protected:
  virtual void observe(const Observation& now, double time_s) = 0;
  virtual bool is_complete() const = 0;
  virtual void take(const Observation& now) = 0;
  virtual std::string too_late() const = 0;

 private:
  Stopwatch since_;
  bool confirmed_ = false, was_pressed_ = true;  // ignores a button pressed before the step
};

}  // namespace inkwell::guides
