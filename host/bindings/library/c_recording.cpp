// Functions of the C interface for marks and texts of recordings, losses and test pulses.
#include <cmath>

#include "host/bindings/library/c_guard.hpp"

using namespace inkwell::library;
namespace protocol = inkwell::protocol;

inkwell_result inkwell_describe_recordings(inkwell_arm* arm, const char* name, const char* note) {
  return guarded([&] { arm_of(arm).describe_recordings(name == nullptr ? "" : name, note == nullptr ? "" : note); });
}

inkwell_result inkwell_mark(inkwell_arm* arm, const char* text) {
  return guarded([&] { arm_of(arm).scope().mark(required(text, "The text")); });
}

inkwell_result inkwell_finish_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost, int* is_complete) {
  return guarded([&] {
    const auto status = arm_of(arm).stop_recording();
    if (samples != nullptr) *samples = status.samples;
    if (lost != nullptr) *lost = status.lost;
    if (is_complete != nullptr) *is_complete = status.is_complete ? 1 : 0;
  });
}

inkwell_result inkwell_get_losses(inkwell_arm* arm, inkwell_losses* losses) {
  return guarded([&] {
    required(losses, "The pointer to the losses");
    const auto counted = arm_of(arm).losses();
    *losses = {counted.poses, counted.servo.poses_missed, counted.servo.slow_calls, counted.servo.longest_call_s};
  });
}

inkwell_result inkwell_send_test_pulse(inkwell_arm* arm, int motor, inkwell_pulse unit, double amplitude,
                                       double duration_s) {
  return guarded([&] {
    if (motor < 1 || motor > 3) throw BadArgument(fmt::format("Motor {} does not exist. Give 1, 2 or 3.", motor));
    if (unit != INKWELL_PULSE_V && unit != INKWELL_PULSE_A)
      throw BadArgument("The unit of the pulse is not known. Give INKWELL_PULSE_V or INKWELL_PULSE_A.");
    if (!std::isfinite(amplitude)) throw BadArgument("The amplitude is not a finite number. Give volts or amperes.");
    constexpr double longest_s = static_cast<double>(protocol::test_duration_maximum_s);
    if (!(duration_s > 0.0 && duration_s <= longest_s))
      throw BadArgument(
          fmt::format("A pulse cannot last {} s. Give more than 0 and at most {:.2g} s.", duration_s, longest_s));
    arm_of(arm).send_test_pulse(
        unit == INKWELL_PULSE_V ? protocol::Command::test_voltage : protocol::Command::test_current,
        {static_cast<std::uint8_t>(motor), static_cast<float>(amplitude), static_cast<float>(duration_s)});
  });
}
