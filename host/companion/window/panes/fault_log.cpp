#include "host/companion/window/panes/fault_log.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/injections.hpp"

namespace inkwell::window {

namespace {

using Phase = LoggedInjection::Phase;

/// After this number of answers, the log records a fault without a time. After a reset, the board may never reach the
/// period count of an earlier fault.
constexpr int patience_answers = 8;

/// Returns true if the fault may stop the control interrupt, which counts the periods.
bool stops_the_count(const device::Injection& injection) {
  const auto fault = protocol::find_injection(injection.fault);
  if (fault == protocol::InjectedFault::main_loop_stalled) return false;  // interrupts continue
  return !fault || protocol::info(*fault).part == protocol::InjectionPart::core;
}

}  // namespace

void FaultLog::add(const device::Injection& injection) {
  const auto known =
      std::ranges::find(faults_, injection.number, [](const auto& each) { return each.injection.number; });
  const Phase phase = injection.has_come ? Phase::in : Phase::to_come;
  if (known == faults_.end()) {
    faults_.push_back({injection, phase, {}});
  } else {
    known->injection = injection;
    known->phase = phase;
  }
}

void FaultLog::take(const device::Injections& now) {
  if (newest_ && now.board_time_s < newest_->board_time_s) *this = {};
  end_those_gone(now);
  for (const device::Injection& each : now.faults) add(each);
  forget_oldest();
  resolve_pending(now);
  newest_ = now;
}

void FaultLog::end_those_gone(const device::Injections& now) {
  for (LoggedInjection& each : faults_)
    if (std::ranges::find(now.faults, each.injection.number, &device::Injection::number) == now.faults.end())
      each.phase = Phase::over;
  // Removes faults that the user canceled before the start time.
  std::erase_if(faults_, [&](const LoggedInjection& each) {
    return each.phase == Phase::over && each.injection.at_s > now.board_time_s;
  });
}

void FaultLog::forget_oldest() {
  const auto is_over = [](const LoggedInjection& each) { return each.phase == Phase::over; };
  for (auto over = std::ranges::count_if(faults_, is_over); over > static_cast<std::ptrdiff_t>(over_maximum); --over)
    faults_.erase(std::ranges::find_if(faults_, is_over));
}

void FaultLog::notice(const device::NoticedFault& fault) {
  pending_ = Pending{fault};
  for (const LoggedInjection& each : faults_)
    if (each.phase == Phase::in) pending_->in.push_back(each.injection.number);
}

bool FaultLog::Pending::was_in(unsigned number) const { return std::ranges::find(in, number) != in.end(); }

double FaultLog::period_s(const device::Injections& now) const {
  constexpr double nominal_s = 1.0 / protocol::servo_rate_Hz, drift_maximum = 0.02;
  if (!newest_ || newest_->period >= now.period) return nominal_s;
  // Measures the control period, because an injected fault can change the crystal frequency. After a board reset,
  // returns the nominal period.
  const double measured_s =
      (now.period_at_s - newest_->period_at_s) / static_cast<double>(now.period - newest_->period);
  return std::abs(measured_s / nominal_s - 1.0) < drift_maximum ? measured_s : nominal_s;
}

void FaultLog::resolve_pending(const device::Injections& now) {
  if (!pending_) return;
  // Compares 32 bits, because the fault's period count may have wrapped.
  const auto at_periods = static_cast<std::uint32_t>(pending_->fault.at_periods);
  const auto periods_ago = static_cast<std::int32_t>(static_cast<std::uint32_t>(now.period) - at_periods);
  const double length_s = period_s(now);
  if (periods_ago >= 0) {
    show_with(pending_->fault.fault, now.period_at_s - (periods_ago - 1) * length_s,
              now.period_at_s - static_cast<double>(now.period) * length_s);
  } else if (++pending_->answers < patience_answers) {
    return;
  } else {
    show_with(pending_->fault.fault, std::nullopt, 0);
  }
  pending_.reset();
}

void FaultLog::show_with(protocol::Fault fault, std::optional<double> noticed_s, double run_began_s) {
  for (LoggedInjection& each : faults_) {
    if (each.noticed || each.phase == Phase::to_come) continue;
    const double came_s = each.injection.at_s;
    const bool is_sure = noticed_s && (!stops_the_count(each.injection) || run_began_s >= came_s);
    const bool was_noticed_since = is_sure ? *noticed_s >= came_s : pending_->was_in(each.injection.number);
    if (was_noticed_since) each.noticed = {fault, is_sure ? std::optional(*noticed_s - came_s) : std::nullopt};
  }
}

}  // namespace inkwell::window
