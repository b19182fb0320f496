#include "firmware/self_test/self_test.hpp"

#include <cmath>

#include "firmware/placement/interrupt.hpp"

namespace inkwell::link {
namespace {

using Item = protocol::SelfTestItem;
using Result = protocol::SelfTestResult;

/// Wires in test order.
constexpr Item tested_wires[] = {Item::encoder_1_a,       Item::encoder_1_b,      Item::encoder_2_a,
                                 Item::encoder_2_b,       Item::encoder_3_a,      Item::encoder_3_b,
                                 Item::bridge_fault_tim1, Item::bridge_fault_tim8};

/// First item of a self-test on command. Earlier items are tested only at start-up.
constexpr Item first_of_each_test = Item::current_offsets;

constexpr std::uint32_t orders = 4;

constexpr control::Triple smallest_resistances{PulseJudgement::smallest_ohm, PulseJudgement::smallest_ohm,
                                               PulseJudgement::smallest_ohm};
constexpr std::array<std::uint32_t, 3> shortest_levels{control::SelfTestPulses::level_periods,
                                                       control::SelfTestPulses::level_periods,
                                                       control::SelfTestPulses::level_periods};

}  // namespace

void SelfTest::note(Item item, Result result, float figure) {
  entry(item).result = result;
  entry(item).figure = figure;
}

std::optional<Item> SelfTest::wanted_wire() const {
  if (phase_ != Phase::wires) return std::nullopt;
  return tested_wires[wire_];
}

void SelfTest::note_wire(bool follows) {
  if (follows && ++following_readings_ < wire_readings) return;
  note(tested_wires[wire_], !follows);
  following_readings_ = 0;
  if (++wire_ < std::size(tested_wires)) return;
  begin_round();
}

void SelfTest::follow(const control::Controller& controller, const control::Settings& settings,
                      const Readings& readings) {
  const auto& [signals, now] = samples_[samples_.recorded() - 1];
  if (begun_.load() != test_) begin(readings, settings, controller.current_offsets_A());
  if (now.state != protocol::State::testing) {
    if (phase_ != Phase::idle && phase_ != Phase::verdict) break_off();
    phase_ = Phase::idle;
  } else if (phase_ == Phase::rest) {
    wait_for_rest(signals, settings.motor_model);
  } else if (phase_ == Phase::pulses && round_is_over_.load()) {
    // Motors that are not confirmed are judged only if the arm is still at rest after the pulses.
    const control::MotorModel& model = settings.motor_model;
    const bool is_judged = model.is_confirmed || rests(signals, model);
    end_round(is_judged ? judge(controller.pulse_round(), settings) : PulseJudgement::moved(), signals);
  }
}

void SelfTest::begin(const Readings& readings, const control::Settings& settings, const control::Triple& offset_A) {
  test_ = begun_.load();
  // Motors that are not confirmed are unknown until a self-test has judged them.
  if (tests_ended_ == 0) measured_.awaits_motors = !settings.motor_model.is_confirmed;
  for (std::size_t i = static_cast<std::size_t>(first_of_each_test); i < entries_.size(); ++i) entries_[i] = {};
  offset_A_ = offset_A;
  test_since_ = samples_.recorded();
  note(Item::analog_supply, readings.analog_supply_is_right, readings.analog_supply_V);
  for (std::size_t i = 0; i < readings.gimbal_ratio.size(); ++i) {
    const float ratio = readings.gimbal_ratio[i];
    note(of_axis(Item::gimbal_1, i), ratio > gimbal_rail_part && ratio < 1.0f - gimbal_rail_part, ratio);
  }
  wire_ = 0;
  following_readings_ = rounds_ = failures_ = 0;
  sizes_pulses_ = !settings.motor_model.is_confirmed;
  pulse_size_ = control::PulseSize::of(settings.motor_model.resistance_ohm);
  // Short pulses suffice for the estimate.
  if (sizes_pulses_) pulse_size_ = {smallest_resistances, shortest_levels};
  phase_ = Phase::wires;
}

/// Measures the sensor offsets. The samples are relative to the offsets at start-up, so the start-up offsets are added.
void SelfTest::note_offsets() {
  const std::uint32_t recorded = samples_.recorded();
  float largest_A = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    float sum_A = 0.0f;
    for (std::uint32_t back = 1; back <= offset_readings; ++back)
      sum_A += samples_[recorded - back].signals[of_axis(protocol::Signal::current_1_A, i)];
    const float reads_A = offset_A_[i] + sum_A * (1.0f / static_cast<float>(offset_readings));
    if (reads_A * reads_A > largest_A * largest_A) largest_A = reads_A;
  }
  constexpr float plausible_A = control::CurrentOffsets::plausible_A;
  note(Item::current_offsets, largest_A <= plausible_A && largest_A >= -plausible_A, largest_A);
}

void SelfTest::break_off() {
  for (auto& entry : entries_)
    if (entry.result == Result::not_done && &entry >= &this->entry(first_of_each_test))
      entry.result = Result::broken_off;
}

void SelfTest::begin_round() {
  phase_ = Phase::rest;
  waits_since_ = samples_.recorded();
}

bool SelfTest::rests(const protocol::SignalValues& signals, const control::MotorModel& model) const {
  const float limit_rad_per_s = sizes_pulses_ ? rest_for_estimate_rad_per_s : rest_rad_per_s;
  bool rests = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const float speed_rad_per_s = std::fabs(signals[of_axis(protocol::Signal::joint_speed_1_rad_s, i)]);
    rests &= model.is_confirmed ? speed_rad_per_s * std::fabs(model.back_emf_Vs_per_rad[i]) < rest_V
                                : speed_rad_per_s < limit_rad_per_s;
  }
  return rests;
}

void SelfTest::wait_for_rest(const protocol::SignalValues& signals, const control::MotorModel& model) {
  if (entry(Item::current_offsets).result == Result::not_done) {
    if (samples_.recorded() - test_since_ < off_periods + offset_readings) return;
    note_offsets();
  }
  if (rests(signals, model)) {
    phase_ = Phase::pulses;
    send_order(Order::pulses);
  } else if (samples_.recorded() - waits_since_ > rest_patience_periods) {
    end_round(PulseJudgement::moved(), signals);
  }
}

void SelfTest::end_round(const PulseJudgement& judgement, const protocol::SignalValues& signals) {
  if (sizes_pulses_ && !judgement.any(Result::moved)) {
    sizes_pulses_ = false;
    control::Triple estimate_ohm{};
    for (std::size_t i = 0; i < 3; ++i) estimate_ohm[i] = estimated_part * judgement.estimate_ohm[i];
    pulse_size_ = control::PulseSize::of(estimate_ohm);
    begin_round();
    return;
  }
  note_pulses(judgement);
  store_measurements(judgement, signals);
  bool is_unexpected = false;
  for (const Result result : {Result::failed, Result::wrong_sign, Result::missing, Result::unknown_motor})
    is_unexpected |= judgement.any(result);
  if (is_unexpected) ++failures_;
  const bool is_conclusive = !is_unexpected && !judgement.any(Result::moved);
  if (is_conclusive || failures_ == failures_to_believe || ++rounds_ == rounds_maximum)
    finish_test();
  else
    begin_round();
}

void SelfTest::note_pulses(const PulseJudgement& judgement) {
  for (std::size_t i = 0; i < 3; ++i) {
    note(of_axis(Item::motor_1, i), judgement.motors[i].result, judgement.motors[i].figure);
    note(of_axis(Item::bridge_1, i), judgement.bridges[i].result, judgement.bridges[i].figure);
  }
  note(Item::current_wires, judgement.wires.result, judgement.wires.figure);
}

/// Stores the new measurements. Values without a new measurement do not change.
void SelfTest::store_measurements(const PulseJudgement& judgement, const protocol::SignalValues& signals) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (judgement.bridges[i].result == Result::passed) measured_.bridge_loss_part[i] = judgement.bridge_loss_part[i];
    if (judgement.resistance_ohm[i] == 0.0f) continue;
    measured_.resistance_ohm[i] = judgement.resistance_ohm[i];
    measured_.heat[i] = signals[of_axis(protocol::Signal::motor_heat_1, i)];
  }
}

void SelfTest::finish_test() {
  ++tests_ended_;
  phase_ = Phase::verdict;
  const protocol::SelfTestReport found = report();
  // A test of a moving arm must not release motors that an earlier test found to be missing or unknown.
  bool has_moved = false;
  for (std::size_t i = 0; i < 3; ++i) has_moved |= entry(of_axis(Item::motor_1, i)).result == Result::moved;
  measured_.awaits_motors = protocol::awaits_motors(found) || (has_moved && measured_.awaits_motors);
  send_order(protocol::takes_force(found) ? Order::fail : Order::pass);
}

void SelfTest::send_order(Order order) {
  round_is_over_.store(false);
  order_.store(test_ * orders + static_cast<std::uint32_t>(order));
}

protocol::SelfTestReport SelfTest::report() const {
  protocol::SelfTestReport report{};
  report.is_running = phase_ != Phase::idle;
  report.tests_begun = test_;
  report.tests_ended = tests_ended_;
  report.time_periods = samples_.recorded();
  for (std::size_t i = 0; i < entries_.size(); ++i) report.entries[i] = entries_[i];
  const Sample* const newest = samples_.newest();
  if (newest == nullptr) return report;
  // A fault from continuous monitoring has precedence over the result of a single test.
  const protocol::Fault reported = newest->summary.fault;
  const auto fail = [&report](Item item) { report.entries[static_cast<std::size_t>(item)].result = Result::failed; };
  if (reported == protocol::Fault::current_sensor) fail(Item::current_offsets);
  if (reported == protocol::Fault::memory_damaged) fail(Item::flash);
  return report;
}

INKWELL_INTERRUPT void SelfTest::exchange(control::Controller& controller) {
  const std::uint32_t number = controller.self_tests();
  begun_.store(number);
  if (pulses_run_ && !controller.pulses_run()) {
    pulses_run_ = false;
    round_is_over_.store(true);
  }
  const std::uint32_t order = order_.load();
  if (order / orders != number) return;
  order_.store(0);
  switch (static_cast<Order>(order % orders)) {
    case Order::none: return;
    case Order::pulses: pulses_run_ = true; return controller.start_pulses(pulse_size_);
    case Order::pass: return controller.pass_self_test(measured_);
    case Order::fail: return controller.raise(protocol::Fault::self_test_failed);
  }
}

}  // namespace inkwell::link
