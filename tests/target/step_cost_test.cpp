// Instructions that one step of the controller takes on the Cortex-M4F. QEMU runs the image with one
// instruction a nanosecond, so SysTick counts instructions in units of 168 MHz / 1 GHz.
#include <doctest/doctest.h>

#include <firmware/control/simulated_arm.hpp>

namespace {

using namespace inkwell;

/// SysTick, counting down at the processor's clock (PM0214, "SysTick timer").
class InstructionCounter {
 public:
  InstructionCounter() {
    reload() = 0xFFFFFF;
    value() = 0;
    control() = 5;
    // A loop of a known number of instructions gives the scale.
    constexpr std::uint32_t rounds = 50'000;
    const std::uint32_t begin = ticks();
    std::uint32_t left = rounds;
    asm volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(left) : : "cc");
    instructions_per_tick_ = 2.0f * rounds / static_cast<float>((begin - ticks()) & 0xFFFFFF);
  }

  std::uint32_t ticks() const { return value(); }
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

TEST_CASE("a step in contact with all encoders moving takes less than 2000 instructions") {
  const protocol::ParameterSet parameters = protocol::default_parameters();
  const control::Settings settings = control::prepare(parameters);
  control::Controller controller = tests::active_controller(settings);
  control::Samples samples = tests::samples_at_rest();
  tests::FakeClock clock;
  const InstructionCounter counter;

  float longest = 0.0f;
  float sum = 0.0f;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    controller.host_alive();
    // An edge in most periods and acceleration: the velocity windows are at their longest walk.
    for (std::size_t joint = 0; joint < 3; ++joint)
      samples.encoder_counts[joint] += static_cast<std::int32_t>(joint) + (i % 3 != 0 ? 1 : 0) - (i > 200 ? 2 : 0);
    const std::uint32_t begin = counter.ticks();
    controller.step(samples, settings, clock);
    controller.finish(clock);
    const float instructions = counter.instructions_since(begin);
    sum += instructions;
    longest = instructions > longest ? instructions : longest;
  }
  MESSAGE("instructions of a step: mean " << sum / steps << ", longest " << longest);
  CHECK(controller.state() == protocol::State::active);
  CHECK(controller.signals()[protocol::Signal::force_N] > 0.0f);
  CHECK(longest > 300.0f);
  CHECK(longest < 2000.0f);
}

}  // namespace
