// Phases with adverse events.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host/lab/campaign/handling.hpp"
#include "host/lab/campaign/wires.hpp"

#include "host/lab/soak/bench.hpp"

namespace inkwell::soak {
namespace {

using device::Vector3;
using protocol::Command;
using protocol::Fault;
using protocol::InjectedFault;
using protocol::Parameter;
using protocol::State;

double host_timeout_s(const Bench& bench) { return static_cast<double>(bench.accepted[Parameter::host_timeout_s]); }

/// Starts a random use of the arm.
void be_in_use(Bench& bench, bool with_force) {
  if (with_force)
    bench.make_active();
  else
    bench.make_ready();
  const double limit_N = static_cast<double>(bench.accepted[Parameter::force_limit_N]);
  bench.move_hand(bench.random.chance(0.5) ? bench.free_point_m() : bench.wall_point_m(0.9 * limit_N),
                  bench.random.from(0.3, 0.6));
  bench.pass(bench.random.from(0.0, 0.7));
}

/// Returns Disturbance::program if the fault may corrupt code or data.
Disturbance disturbance_by(InjectedFault fault) {
  switch (fault) {
    case InjectedFault::program_astray:
    case InjectedFault::ram_bit:
    case InjectedFault::flash_bit:
    case InjectedFault::exception_lost:
    case InjectedFault::logic_sag: return Disturbance::program;
    default: return Disturbance::hardware;
  }
}

/// Returns true if the fault may cause lost encoder counts.
bool may_lose_counts(const campaign::CaseFault& put_in) {
  switch (*put_in.fault) {
    case InjectedFault::encoder_stuck:
    case InjectedFault::encoder_lost_counts:
    case InjectedFault::encoder_slip: return true;
    default: return campaign::wire_of(put_in.of) == campaign::Wire::encoder;
  }
}

bool try_to_regain_force(Bench& bench) {
  try {
    bench.oracle.connected();
    if (!bench.board.connected() && !bench.board.connect(1.0)) return false;
    // The phase checks faults and restarts before it requests force again.
    bench.check_closely();
    bench.pass(0.02);
    bench.oracle.request_force();
    return campaign::regain_force(bench.board);
  } catch (const device::Error&) {
    return false;
  }
}

/// Returns true if only a reset clears the fault.
bool reset_is_the_way(Bench& bench) {
  if (bench.board.is_locked_up()) return true;
  return bench.board.is(State::fault) &&
         protocol::condition_table[protocol::index_of(bench.board.pose()->fault)].clearing ==
             protocol::Clearing::by_reset;
}

/// Returns the action that restored the force.
std::string recover(Bench& bench, Disturbance disturbance) {
  bench.board.control().heal_all();
  bench.pass(0.05);
  const bool may_reset = disturbance == Disturbance::program || reset_is_the_way(bench);
  std::string way = bench.board.is(State::fault) ? "clear fault" : "force on";
  bool works = disturbance != Disturbance::program && try_to_regain_force(bench);
  if (!works) {
    way = "reset";
    if (!may_reset && !reset_is_the_way(bench)) bench.oracle.complain(Complaint::no_way_back, "only a reset helped");
    bench.board.reset();
    works = try_to_regain_force(bench);
  }
  bench.check_truth();
  bench.check_closely();
  bench.disturb(Disturbance::none);
  bench.oracle.allow_no_fault();
  if (!works) bench.fail(Complaint::no_way_back, "not even a reset helped");
  return way;
}

}  // namespace

std::string pull_cable(Bench& bench) {
  const bool with_force = bench.random.chance(0.8);
  be_in_use(bench, with_force);
  const double out_s = bench.random.from(0.01, 0.5);
  bench.device_may_go = true;
  bench.oracle.withdraw_force(host_timeout_s(bench));
  bench.board.control().usb(false);
  bench.pass(out_s);
  bench.board.drop_device();
  bench.board.control().usb(true);
  bench.connect();
  bench.device_may_go = false;
  if (with_force)
    bench.oracle.require_report_of(protocol::condition(Fault::usb_gone));
  else if (bench.oracle.has_reported())
    bench.oracle.complain(Complaint::false_trip, "the force was already off");
  bench.go_on();
  return fmt::format("out for {:.3f} s, with the force {}", out_s, with_force ? "on" : "off");
}

std::string be_silent(Bench& bench) {
  be_in_use(bench, true);
  // The last heartbeat may be two check intervals old.
  const double short_s = bench.random.from(0.1, 0.7) * host_timeout_s(bench);
  bench.pass(short_s, false);
  bench.pass(0.02);
  if (bench.oracle.has_reported())
    bench.oracle.complain(Complaint::false_trip, fmt::format("after {:.0f} ms of silence", 1e3 * short_s));
  const double long_s = host_timeout_s(bench) + bench.random.from(0.02, 0.4);
  bench.pass(long_s, false);
  bench.oracle.require_report_of(protocol::condition(Fault::host_silent));
  bench.go_on();
  return fmt::format("for {:.0f} and {:.0f} ms", 1e3 * short_s, 1e3 * long_s);
}

std::string kill_program(Bench& bench) {
  be_in_use(bench, true);
  if (!bench.board.device().drives()) bench.board.device().claim();
  if (bench.random.chance(0.5)) bench.board.device().send_force({.force_N = {2.0f, 0.0f, -1.0f}, .interval_ms = 20});
  bench.device_may_go = true;
  bench.oracle.withdraw_force(host_timeout_s(bench));
  bench.board.drop_device();
  const double gone_s = bench.random.from(0.0, 0.5);
  bench.pass(gone_s);
  bench.connect();
  bench.device_may_go = false;
  bench.oracle.require_report_of(host_gone);
  bench.go_on();
  return fmt::format("another program connected after {:.3f} s", gone_s);
}

std::string reset_board(Bench& bench) {
  be_in_use(bench, bench.random.chance(0.7));
  if (bench.random.chance(0.3)) bench.set(legal_changes(bench.random, bench.accepted, Reach::careful, 5));
  bench.reset();
  bench.check_parameters();  // expects the defaults
  bench.make_active();
  return "";
}

std::string be_too_fast(Bench& bench) {
  be_in_use(bench, true);
  bench.move_hand(bench.free_point_m(), 0.5);
  bench.pass(0.7);
  const auto limit_m_per_s = static_cast<float>(bench.random.from(0.2, 0.5));
  bench.set({Parameter::speed_limit_m_per_s, limit_m_per_s});
  Vector3 there_m = campaign::middle_of_box_m(bench.defaults), back_m = there_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    there_m[axis] += 0.03;
    back_m[axis] -= 0.03;
  }
  // The peak speed is 1.9 m/s.
  bench.board.control().hand_path({{0.3, there_m}, {0.4, back_m}, {0.5, there_m}});
  bench.pass(0.6);
  bench.oracle.require_report_of(protocol::condition(Fault::over_speed));
  bench.set({Parameter::speed_limit_m_per_s, bench.defaults[Parameter::speed_limit_m_per_s]});
  bench.pass(0.2);
  bench.go_on();
  return fmt::format("faster than {:.2f} m/s", static_cast<double>(limit_m_per_s));
}

std::string put_fault_in(Bench& bench) {
  static const auto faults = [] {
    auto all = campaign::case_faults();
    std::erase_if(all, [](const campaign::CaseFault& each) { return !each.fault; });
    return all;
  }();
  const auto& listed = faults[bench.random.below(faults.size())];
  const auto put_in = campaign::at_another(listed, 1 + static_cast<unsigned>(bench.random.below(3)));
  const bool with_force = bench.random.chance(0.8);
  be_in_use(bench, with_force);
  const Disturbance disturbance = disturbance_by(*put_in.fault);
  bench.disturb(disturbance);
  const std::string name(protocol::info(*put_in.fault).name);
  ++bench.sitting.faults_put_in[*put_in.fault];
  if (bench.random.chance(0.5)) bench.move_hand(bench.free_point_m(), bench.random.from(0.15, 0.5));
  bench.board.control().inject({name, put_in.of, put_in.amount, 0.0, put_in.for_s});
  bench.pass(bench.random.from(0.05, 0.8));
  const auto reported_fault = bench.oracle.last_reported();
  const std::string way = recover(bench, disturbance);
  // Lost counts may be detected later, during the motion to the inkwell.
  if (may_lose_counts(put_in)) bench.oracle.allow_lost_counts();
  bench.withdraw_force();
  bench.dock();
  bench.oracle.allow_no_fault();
  bench.take_out();
  bench.make_active();
  bench.pass(0.3);
  return fmt::format("{} with the force {}: {}, {}", put_in.name(), with_force ? "on" : "off",
                     reported_fault ? protocol::info(*reported_fault).name : "nothing told", way);
}

}  // namespace inkwell::soak
