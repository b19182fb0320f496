// If a force law divides by zero, the force is switched off, the fault states the cause, and the law restarts.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>

#include "host/client/device/fault_text.hpp"
#include "host/client/device/parameter_file.hpp"

#include "tests/system/board_rig.hpp"

namespace inkwell::tests {
namespace {

using namespace std::chrono_literals;
using protocol::Command;
using protocol::Fault;
using protocol::Parameter;
using protocol::Signal;
using protocol::State;

TEST_CASE("a force law that divides by zero switches the force off with the fault force_law and produces no kick") {
  BoardRig rig(std::string("quotient.elf"));
  const Parameter divisor = device::parameter_named("quotient_divisor");
  const Parameter dividend = device::parameter_named("quotient_dividend_N");
  const Signal periods = *protocol::find_signal("quotient_periods");
  rig.set({{Parameter::force_ramp_s, 0.0f}});
  rig.take_to(free_point_m);
  // 0.5 / 0 is infinite, and 0 / 0 is not a number.
  for (const float dividend_N : {0.5f, 0.0f}) {
    rig.set({{divisor, 1.0f}, {dividend, 0.5f}});
    rig.make_active();
    rig.run(0.1);
    CHECK(rig.pose().force_N[2] == doctest::Approx(0.5).epsilon(1e-4));
    rig.device->select_signals(std::array{Signal::force_N, Signal::current_reference_1_A, periods});
    rig.run(0.05);
    rig.set({{divisor, 0.0f}, {dividend, dividend_N}});
    rig.run_until([](const auto& pose) { return pose.state == State::fault; });
    CHECK(rig.pose().fault == Fault::force_law);
    CHECK(device::fault_line(rig.pose().fault).find("division by zero") != std::string::npos);
    rig.run(0.1);
    float largest_N = 0.0f, most_periods = 0.0f, last_periods = 1.0f;
    bool is_finite = true;
    while (const auto samples = rig.device->read_scope(0ms))
      for (std::size_t i = 0; i < samples->values.size(); i += 3) {
        is_finite &= std::isfinite(samples->values[i]) && std::isfinite(samples->values[i + 1]);
        largest_N = std::max(largest_N, samples->values[i]);
        last_periods = samples->values[i + 2];
        most_periods = std::max(most_periods, last_periods);
      }
    CHECK(is_finite);
    CHECK(largest_N < 0.5001f);
    CHECK(most_periods > 1000.0f);
    CHECK(last_periods == 0.0f);  // state and signals are reinitialized
    CHECK(rig.pose().force_N[2] == 0.0f);
    CHECK(largest_current_A(rig.control) < 0.05);
    rig.device->select_signals({});
    rig.command(Command::clear_fault);
    rig.run_until([](const auto& pose) { return pose.state == State::ready; });
  }
}

}  // namespace
}  // namespace inkwell::tests
