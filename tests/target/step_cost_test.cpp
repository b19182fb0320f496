// Instructions per step of the controller on the Cortex-M4F. QEMU executes one instruction per nanosecond, and SysTick
// counts with 168 MHz.
#include <doctest/doctest.h>

#include "tests/firmware/control/arms.hpp"
#include "tests/firmware/control/simulated_arm.hpp"

namespace {

using namespace inkwell;

/// SysTick, counting down with the processor clock (PM0214, "SysTick timer").
class InstructionCounter {
 public:
  InstructionCounter() {
    reload() = 0xFFFFFF;
    value() = 0;
    control() = 5;
    // A loop with a known number of instructions calibrates the counter.
    constexpr std::uint32_t rounds = 50'000;
    const std::uint32_t begin = ticks();
    std::uint32_t left = rounds;
    asm volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(left) : : "cc");
    instructions_per_tick_ = 2.0f * rounds / static_cast<float>((begin - ticks()) & 0xFFFFFF);
  }

  std::uint32_t ticks() const { return value(); }
  float instructions_per_tick() const { return instructions_per_tick_; }
  float instructions_since(std::uint32_t begin) const {
    return static_cast<float>((begin - ticks()) & 0xFFFFFF) * instructions_per_tick_;
  }

 private:
  static volatile std::uint32_t& at(std::uint32_t address) {
    return *reinterpret_cast<volatile std::uint32_t*>(address);
  }
  static volatile std::uint32_t& control() { return at(0xE000E010); }
  static volatile std::uint32_t& reload() { return at(0xE000E014); }
  static volatile std::uint32_t& value() { return at(0xE000E018); }

  float instructions_per_tick_;
};

/// Measures the controller's stages in SysTick ticks. Reading this clock costs about as much as reading the board's
/// clock.
struct StageClock {
  const InstructionCounter& counter;
  std::uint32_t begin = counter.ticks();

  std::uint32_t lap() {
    const std::uint32_t before = begin;
    begin = counter.ticks();
    return (before - begin) & 0xFFFFFF;
  }
};

/// The box is far from the arm, so every step has contact with three walls and reaches the force limit. The joints move
/// without current, because the motors are not simulated.
protocol::ParameterSet parameters_out_of_box() {
  using enum protocol::Parameter;
  protocol::ParameterSet set = tests::without_motors(tests::omni_parameters());
  for (const auto constant : {torque_constant_1_Nm_per_A, torque_constant_2_Nm_per_A, torque_constant_3_Nm_per_A})
    set[constant] = protocol::info(constant).minimum;
  set[box_minimum_x_m] = set[box_minimum_y_m] = set[box_minimum_z_m] = 0.4f;
  set[box_maximum_x_m] = set[box_maximum_y_m] = set[box_maximum_z_m] = 0.5f;
  return set;
}

TEST_CASE("a step in contact with all encoders moving takes less than 2400 instructions") {
  const control::Settings settings = control::prepare(parameters_out_of_box());
  control::Controller controller = tests::active_controller(settings);
  control::Samples samples = tests::samples_at_rest();
  const InstructionCounter counter;

  float longest = 0.0f;
  float sum = 0.0f;
  using enum protocol::Signal;
  constexpr std::array stage_signals{stage_sample_cycles, stage_pose_cycles,    stage_contact_cycles,
                                     stage_torque_cycles, stage_current_cycles, stage_report_cycles};
  std::array<float, stage_signals.size()> stages{};
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    controller.host_alive();
    // The search in the velocity windows is longest if each joint has an edge in two of three periods.
    for (std::int32_t& counts : samples.encoder_counts) counts += i % 3 != 0 ? 1 : 0;
    StageClock clock{counter};
    const std::uint32_t begin = counter.ticks();
    controller.step(samples, settings, clock);
    const float instructions = counter.instructions_since(begin);
    controller.finish(clock);
    sum += instructions;
    longest = instructions > longest ? instructions : longest;
    for (std::size_t stage = 0; stage < stages.size(); ++stage)
      stages[stage] += controller.signals()[stage_signals[stage]] * counter.instructions_per_tick() / steps;
  }
  MESSAGE("instructions of a step: mean " << sum / steps << ", longest " << longest);
  MESSAGE("by stage: sample " << stages[0] << ", pose " << stages[1] << ", contact " << stages[2] << ", torque "
                              << stages[3] << ", current " << stages[4] << ", report " << stages[5]);
  CHECK(protocol::force_is_on(controller.state()));
  CHECK(controller.signals()[protocol::Signal::force_N] > 0.0f);
  CHECK(controller.signals()[protocol::Signal::joint_speed_3_rad_s] > 0.0f);
  CHECK(longest > 300.0f);
  // QEMU counts instructions. A test with the complete firmware checks the duration of the interrupt in cycles.
  CHECK(longest < 2400.0f);
}

}  // namespace
