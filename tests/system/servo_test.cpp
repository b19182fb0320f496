// The control interrupt's cost, and that the virtual board repeats itself.
#include <doctest/doctest.h>

#include <algorithm>

#include <board/omni_driver.hpp>

#include "rig.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using protocol::Parameter;
using protocol::Signal;

TEST_CASE("the longest control interrupt stays under half of its period, in contact and with a full scope") {
  Rig rig;
  rig.make_active();
  std::vector<Signal> signals;
  for (std::uint8_t id = 0; id < 31; ++id) signals.push_back(static_cast<Signal>(id));
  rig.call([&](device::Device& arm) { arm.select_signals(signals); });
  rig.take_to(free_point_m);
  // Inside two walls, and moving through them.
  rig.set({{Parameter::box_minimum_z_m, -0.02f}, {Parameter::box_maximum_x_m, 0.0f}});
  rig.take_to({0.02, 0.0, -0.045}, 0.3);
  rig.take_to(free_point_m, 0.3);
  const auto report = rig.call([](device::Device& arm) { return arm.information(); }).report;
  MESSAGE("simulation: longest control interrupt ", report.servo_cycles_longest, " of ", board::servo_cycles,
          " cycles, one an instruction");
  CHECK(report.servo_cycles_longest > 500);  // it did run and was measured
  CHECK(report.servo_cycles_longest < board::servo_cycles / 2);
  CHECK(report.servo_overruns == 0);
}

TEST_CASE("exact mode gives the same run for the same seed, to the instruction") {
  const auto run = [](std::uint64_t seed) {
    device::VirtualBoardOptions options;
    options.mode = device::SimulationMode::exact;
    options.seed = seed;
    options.real_time = false;
    options.paused = true;
    const device::VirtualBoard board(options);
    auto control = board.control();
    control.trace_start();
    control.dock(false);  // the arm falls from its inkwell under gravity
    control.run(0.25);
    return std::pair(control.trace_read(100'000).values, control.status().all.at("instructions").get<std::uint64_t>());
  };
  const auto first = run(7);
  REQUIRE(first.first.size() > 4000);
  REQUIRE(first.second > 1'000'000);
  CHECK(first == run(7));
}
