// Current loops: measures each motor, suggests gains and resistances, and tests the gains.
#include "host/client/guides/guides.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "boards/known/boards.hpp"
#include "host/client/device/parameter_file.hpp"
#include "host/client/guides/motor_identification.hpp"
#include "host/client/guides/pulse_recorder.hpp"
#include "host/client/recording/current_step.hpp"

#include "host/client/guides/joint_motion.hpp"
#include "host/client/guides/pulse_log.hpp"
#include "host/client/guides/pulse_size.hpp"

namespace inkwell::guides {
namespace {

using nlohmann::ordered_json;
using protocol::Command;
using protocol::Parameter;
using protocol::ParameterSet;
using protocol::Signal;
using protocol::TestPulse;

constexpr double period_s = 1.0 / protocol::servo_rate_Hz;
constexpr float voltage_pulse_s = 0.01f;  // tens of winding time constants of a small motor
constexpr float first_voltage_V = 1.0f, largest_voltage_V = 4.0f;
constexpr float smallest_ohm = 0.5f;  ///< of a motor that the user has not confirmed
constexpr int pairs_of_pulses = 3;    // at the higher voltage; a forward and a backward pulse cancel the arm's motion
constexpr float step_pulse_s = 0.02f, step_A = 0.5f;
constexpr double ripple_A = static_cast<double>(board::current_ripple_A(arm_defaults::motor::inductance_H)) / 2;

/// Fits the circuit of a motor. The current ripple depends on the fitted inductance, so the fit is repeated.
MotorCircuit identify_circuit(const std::vector<VoltagePulse>& pulses) {
  constexpr int repetitions = 4;
  MotorCircuit circuit = identify(pulses, period_s, ripple_A);
  for (int i = 0; i < repetitions; ++i) {
    const double fitted_ripple_A = board::current_ripple_A(static_cast<float>(circuit.inductance_H)) / 2.0;
    circuit = identify(pulses, period_s, fitted_ripple_A);
  }
  return circuit;
}

/// Rounds to four digits, the precision of the fit.
double to_four_digits(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 3);
  return step * std::round(value / step);
}

/// Rounds to 0.1, without a negative zero.
double tenths(double value) { return 0.1 * std::round(10.0 * value) + 0.0; }

/// Data shared by the steps of this guide.
struct Tuning {
  CurrentLoopOptions options;
  std::string board_name;
  const board::Facts* board = nullptr;  ///< null: this companion does not know the connected board
  std::vector<MotorCircuit> motors;     ///< in the order of options.motors
  std::optional<SuggestedGains> gains;
  std::vector<recording::CurrentStep> before, after;
  PulseLog log;

  explicit Tuning(CurrentLoopOptions chosen) : options(std::move(chosen)), log(options.pulses) {}
  void name_board(const std::string& name) {
    board_name = name;
    board = board::find_board(name);
  }
  /// Motor resistance without the shunt, which belongs to the board.
  std::optional<double> motor_ohm(const MotorCircuit& circuit) const {
    if (board == nullptr) return std::nullopt;
    return circuit.resistance_ohm - static_cast<double>(board->shunt_ohm);
  }
};

double held(const ParameterSet& set, protocol::EachAxis<Parameter> rows, int motor) {
  return static_cast<double>(set[of_number(rows, motor)]);
}

/// Test current, well below the motor's limit.
float test_current_A(const ParameterSet& set, int motor) {
  return std::min({step_A, 0.5f * set[of_number(Parameter::current_limit_1_A, motor)], allowed_pulse_A(set, motor)});
}

class IdentifyMotor final : public Step {
 public:
  IdentifyMotor(std::shared_ptr<Tuning> tuning, std::shared_ptr<Findings> findings, int motor)
      : tuning_(std::move(tuning)), findings_(std::move(findings)), motor_(motor) {}

  std::string title() const override { return fmt::format("Identify motor {}", motor_); }
  std::string text() const override {
    return fmt::format(
        "Motor {} receives {} pulses of {:.0f} ms, first with {:.0f} V, then with at most {:.0f} V, forward and "
        "backward. The arm may twitch. Leave the stylus in the inkwell and do not touch the arm. The wall force stays "
        "off.",
        motor_, 2 * (1 + pairs_of_pulses), 1e3f * voltage_pulse_s, first_voltage_V, largest_voltage_V);
  }
  bool needs_consent() const override { return true; }

  void begin(const Observation& now, DevicePort& port) override {
    set_ = *now.parameters;
    tuning_->name_board(now.information ? now.information->board_name : "");
    const float parameter_ohm = set_[of_number(Parameter::motor_resistance_1_ohm, motor_)];
    const bool is_confirmed = set_[Parameter::motors_confirmed] == 1.0f;
    const float resistance_ohm = is_confirmed ? parameter_ohm : std::min(parameter_ohm, smallest_ohm);
    first_V_ = std::min(first_voltage_V, expected_dead_V() + allowed_pulse_A(set_, motor_) * resistance_ohm);
    start_pulse(first_V_, now, port);
  }
  void receive(const device::ScopeSamples& samples) override {
    if (recorder_) recorder_->receive(samples);
  }

  bool advance(const Observation& now, DevicePort& port) override {
    if (!recorder_->advance(*now.pose, port)) return false;
    tuning_->log.add(now, recorder_->recording(),
                     fmt::format("motor {}: {:g} V for {:g} ms", motor_, pulse_V_, 1e3f * voltage_pulse_s));
    pulses_.push_back(taken_pulse());
    if (pulses_.size() == 2) choose_voltage();
    if (pulses_.size() < 2 * (1 + pairs_of_pulses)) {
      const float amplitude_V = pulses_.size() < 2 ? first_V_ : voltage_V_;
      start_pulse(pulses_.size() % 2 == 0 ? amplitude_V : -amplitude_V, now, port);
      return false;
    }
    const MotorCircuit circuit = identify_circuit(pulses_);
    tuning_->motors.push_back(circuit);
    report(circuit);
    return true;
  }

  std::vector<Check> checks() const override {
    std::vector<Check> checks{{"pulses recorded", static_cast<double>(pulses_.size()), "",
                               fmt::format("{}", 2 * (1 + pairs_of_pulses)),
                               pulses_.size() == 2 * (1 + pairs_of_pulses)}};
    if (pulses_.empty()) return checks;
    double largest_A = 0;
    for (const double current_A : pulses_.back().current_A) largest_A = std::max(largest_A, std::abs(current_A));
    checks.push_back(
        {fmt::format("largest current of motor {}", motor_), largest_A, "A", "more than 0.05", largest_A > 0.05});
    return checks;
  }
  double progress() const override { return static_cast<double>(pulses_.size()) / (2 * (1 + pairs_of_pulses)); }

 private:
  void start_pulse(float voltage_V, const Observation& now, DevicePort& port) {
    pulse_V_ = voltage_V;
    recorder_.emplace(Command::test_voltage, TestPulse{static_cast<std::uint8_t>(motor_), voltage_V, voltage_pulse_s},
                      std::vector<Signal>{of_number(Signal::current_1_A, motor_), of_number(Signal::duty_1, motor_),
                                          Signal::supply_V, of_number(Signal::joint_speed_1_rad_s, motor_)},
                      of_number(Signal::duty_1, motor_));
    recorder_->begin(*now.pose, port);
  }

  VoltagePulse taken_pulse() const {
    const auto supply_V = recorder_->values_of(Signal::supply_V);
    const auto speed_rad_s = recorder_->values_of(of_number(Signal::joint_speed_1_rad_s, motor_));
    const double sign = held(set_, Parameter::motor_1_reversed, motor_) == 1.0 ? -1.0 : 1.0;
    const double back_emf_Vs =
        sign * held(set_, Parameter::gear_ratio_1, motor_) * held(set_, Parameter::torque_constant_1_Nm_per_A, motor_);
    VoltagePulse pulse{recorder_->values_of(of_number(Signal::duty_1, motor_)),
                       recorder_->values_of(of_number(Signal::current_1_A, motor_)), speed_rad_s};
    for (std::size_t i = 0; i < pulse.voltage_V.size(); ++i) {
      pulse.voltage_V[i] *= supply_V[i];
      pulse.back_emf_V[i] *= back_emf_Vs;
    }
    return pulse;
  }

  /// Chooses the second voltage. The second voltage is chosen for twice the current of the step test, up to the allowed
  /// current. The estimate uses the first pulse's current and the board's dead-time voltage.
  void choose_voltage() {
    identify(pulses_, period_s, ripple_A);  // throws if the currents do not match the circuit
    const auto wanted_A =
        static_cast<double>(std::min(2.0f * test_current_A(set_, motor_), allowed_pulse_A(set_, motor_)));
    const double lost_V = std::min(dead_time_V(), 0.5 * static_cast<double>(first_V_));
    const double resistance_ohm = (static_cast<double>(first_V_) - lost_V) / settled_A();
    voltage_V_ = std::clamp(static_cast<float>(lost_V + resistance_ohm * wanted_A), first_V_, largest_voltage_V);
  }

  float expected_dead_V() const {
    return tuning_->board == nullptr ? 0.0f : tuning_->board->bridge_dead_time_part() * board::supply_nominal_V;
  }

  double dead_time_V() const {
    if (tuning_->board == nullptr) return 0.0;
    return static_cast<double>(tuning_->board->bridge_dead_time_part()) * recorder_->values_of(Signal::supply_V).back();
  }

  /// Mean current of both pulses in the last millisecond of each pulse.
  double settled_A() const {
    constexpr std::size_t samples = protocol::servo_rate_Hz / 1000;
    double sum_A = 0.0;
    for (const VoltagePulse& pulse : pulses_) {
      const auto last_on = std::ranges::find_if(pulse.voltage_V.rbegin(), pulse.voltage_V.rend(),
                                                [](double voltage_V) { return voltage_V != 0.0; });
      const auto end = static_cast<std::size_t>(pulse.voltage_V.rend() - last_on);
      for (std::size_t i = end < samples ? 0 : end - samples; i < end; ++i) sum_A += std::abs(pulse.current_A[i]);
    }
    return sum_A / static_cast<double>(samples * pulses_.size());
  }

  void report(const MotorCircuit& circuit) {
    const auto motor_ohm = tuning_->motor_ohm(circuit);
    const std::string resistance =
        motor_ohm ? fmt::format("{:.3f} ohm with both switches of the bridge ({:.3f} ohm with the shunt)", *motor_ohm,
                                circuit.resistance_ohm)
                  : fmt::format("{:.3f} ohm with both switches of the bridge and the shunt", circuit.resistance_ohm);
    findings_->sentences.push_back(fmt::format(
        "Motor {}: R = {}, L = {:.4f} mH, time constant {:.0f} us, dead-time loss {:.2f} V, fit within {:.1f} mA.",
        motor_, resistance, 1e3 * circuit.inductance_H, 1e6 * circuit.inductance_H / circuit.resistance_ohm,
        circuit.dead_time_voltage_V, 1e3 * circuit.residual_A));
    findings_->details["motors"].push_back({{"motor", motor_},
                                            {"resistance_ohm", motor_ohm ? ordered_json(*motor_ohm) : nullptr},
                                            {"resistance_includes", "winding and both switches of the bridge"},
                                            {"circuit_resistance_ohm", circuit.resistance_ohm},
                                            {"inductance_H", circuit.inductance_H},
                                            {"dead_time_voltage_V", circuit.dead_time_voltage_V},
                                            {"delay_s", circuit.delay_s},
                                            {"residual_A", circuit.residual_A}});
  }

  std::shared_ptr<Tuning> tuning_;
  std::shared_ptr<Findings> findings_;
  int motor_;
  ParameterSet set_{};
  float first_V_ = first_voltage_V, voltage_V_ = first_voltage_V, pulse_V_ = 0.0f;
  std::optional<PulseRecorder> recorder_;
  std::vector<VoltagePulse> pulses_;
};

/// Tests the current step of each motor with the device's gains or the suggested gains.
class TryGains final : public Step {
 public:
  TryGains(std::shared_ptr<Tuning> tuning, std::shared_ptr<Findings> findings, bool suggested)
      : tuning_(std::move(tuning)), findings_(std::move(findings)), suggested_(suggested) {}

  std::string title() const override {
    return suggested_ ? "Step response with the suggested gains" : "Step response now";
  }
  std::string text() const override {
    const std::string pulses = fmt::format("Motor {} receives a current step of {:.1f} A for {:.0f} ms",
                                           fmt::join(tuning_->options.motors, ", then "), step_A, 1e3f * step_pulse_s);
    if (!suggested_) return pulses + " with the present gains of the device. Leave the stylus in the inkwell.";
    return pulses +
           " with the suggested gains. The device uses these gains for this test only. It keeps its old gains until "
           "you apply the suggested gains. Leave the stylus in the inkwell.";
  }
  bool needs_consent() const override { return true; }

  void begin(const Observation& now, DevicePort& port) override {
    old_ = *now.parameters;
    if (!suggested_) {
      start_pulse(now, port);
      return;
    }
    suggest();
    port.set_parameters(gains_of(*tuning_->gains));
    lent_ = true;
    since_.start(*now.pose);
  }
  void receive(const device::ScopeSamples& samples) override {
    if (recorder_) recorder_->receive(samples);
  }

  bool advance(const Observation& now, DevicePort& port) override {
    if (!recorder_) {
      if (!holds_suggested(*now.parameters)) {
        if (now.refusal) throw device::Error(*now.refusal);
        if (since_.seconds(*now.pose) > 3.0)
          throw device::Error("The device did not accept the suggested gains. Reset the board.");
        return false;
      }
      start_pulse(now, port);
    }
    if (!recorder_->advance(*now.pose, port)) return false;
    tuning_->log.add(now, recorder_->recording(),
                     fmt::format("motor {}: current step, {} gains", tuning_->options.motors[steps().size()],
                                 suggested_ ? "suggested" : "present"));
    take_step();
    if (steps().size() < tuning_->options.motors.size()) {
      start_pulse(now, port);
      return false;
    }
    if (suggested_) propose();
    return true;
  }

  std::vector<device::ParameterChange> to_put_back() const override {
    if (!lent_) return {};
    return {{Parameter::current_proportional_gain_V_per_A, old_[Parameter::current_proportional_gain_V_per_A]},
            {Parameter::current_integral_gain_V_per_As, old_[Parameter::current_integral_gain_V_per_As]}};
  }

  std::vector<Check> checks() const override {
    std::vector<Check> checks;
    const auto& done = suggested_ ? tuning_->after : tuning_->before;
    for (std::size_t i = 0; i < done.size(); ++i) {
      const int motor = tuning_->options.motors[i];
      checks.push_back({fmt::format("motor {} rises to 63 % in", motor), 1e6 * done[i].rise_time_s, "us", "", true});
      checks.push_back({fmt::format("motor {} overshoots by", motor), 1e2 * done[i].overshoot, "%", "less than 15",
                        done[i].overshoot < 0.15});
    }
    return checks;
  }
  double progress() const override {
    return static_cast<double>((suggested_ ? tuning_->after : tuning_->before).size()) /
           static_cast<double>(tuning_->options.motors.size());
  }

 private:
  std::vector<recording::CurrentStep>& steps() { return suggested_ ? tuning_->after : tuning_->before; }

  void start_pulse(const Observation& now, DevicePort& port) {
    const int motor = tuning_->options.motors[steps().size()];
    recorder_.emplace(
        Command::test_current, TestPulse{static_cast<std::uint8_t>(motor), test_current_A(old_, motor), step_pulse_s},
        std::vector<Signal>{of_number(Signal::current_reference_1_A, motor), of_number(Signal::current_1_A, motor)},
        of_number(Signal::current_reference_1_A, motor));
    recorder_->begin(*now.pose, port);
  }

  void take_step() {
    const int motor = tuning_->options.motors[steps().size()];
    const auto& reference_A = recorder_->column(of_number(Signal::current_reference_1_A, motor));
    const auto& current_A = recorder_->column(of_number(Signal::current_1_A, motor));
    const auto step = recording::current_step(reference_A, current_A);
    steps().push_back(step);
    const char* when = suggested_ ? "after" : "before";
    Curve curve{fmt::format("motor {}, {}", motor, when), {}};
    constexpr double shown_ms = 4;
    const auto begin =
        static_cast<double>(std::ranges::find_if(reference_A, [](float r) { return r != 0; }) - reference_A.begin());
    for (std::size_t i = 0; i < current_A.size(); ++i) {
      const double time_ms = 1e3 * (static_cast<double>(i) - begin) * period_s;
      if (time_ms <= shown_ms) curve.points.emplace_back(time_ms, current_A[i]);
    }
    findings_->curves.push_back(std::move(curve));
    findings_->details["steps"].push_back({{"motor", motor},
                                           {"gains", when},
                                           {"amplitude_A", step.amplitude_A},
                                           {"rise_time_s", step.rise_time_s},
                                           {"overshoot", step.overshoot},
                                           {"steady_error_A", step.steady_error_A}});
  }

  /// Lowers the bandwidth if the gains would be out of their ranges.
  void lower_bandwidth(const MotorCircuit& motor) {
    constexpr double part = 0.99;  // margin for the rounded gains
    const SuggestedGains per_Hz = suggest_gains(motor, 1.0);
    const auto maximum = [](Parameter parameter) { return static_cast<double>(protocol::info(parameter).maximum); };
    const double largest_Hz =
        part * std::min(maximum(Parameter::current_proportional_gain_V_per_A) / per_Hz.proportional_V_per_A,
                        maximum(Parameter::current_integral_gain_V_per_As) / per_Hz.integral_V_per_As);
    if (tuning_->options.bandwidth_Hz <= largest_Hz) return;
    tuning_->options.bandwidth_Hz = std::floor(largest_Hz);
    findings_->sentences.push_back(fmt::format(
        "The ranges of the gains limit the bandwidth of this motor to {:.0f} Hz.", tuning_->options.bandwidth_Hz));
  }

  /// The motors share their gains, so the gains are computed for the mean motor.
  void suggest() {
    MotorCircuit mean;
    const auto count = static_cast<double>(tuning_->motors.size());
    for (const auto& motor : tuning_->motors) {
      mean.resistance_ohm += motor.resistance_ohm / count;
      mean.inductance_H += motor.inductance_H / count;
      mean.delay_s += motor.delay_s / count;
    }
    lower_bandwidth(mean);
    const auto exact = suggest_gains(mean, tuning_->options.bandwidth_Hz);
    tuning_->gains = {to_four_digits(exact.proportional_V_per_A), to_four_digits(exact.integral_V_per_As)};
    // The bridge applies a voltage for one period, so the mean delay is half a period.
    const double margin_deg = phase_margin_deg(tuning_->options.bandwidth_Hz, mean.delay_s + period_s / 2);
    for (const auto& [parameter, value] : gains_of(*tuning_->gains)) device::check_value(parameter, value);
    for (std::size_t i = 0; i < tuning_->motors.size(); ++i)
      if (const auto motor_ohm = tuning_->motor_ohm(tuning_->motors[i]))
        device::check_value(resistance_of(i), static_cast<float>(*motor_ohm));
    findings_->sentences.push_back(fmt::format(
        "For {:.0f} Hz: Kp = L w = {:.3f} V/A, Ki = R w = {:.0f} V/(As); the delay leaves {:.0f} degrees of "
        "phase margin.",
        tuning_->options.bandwidth_Hz, tuning_->gains->proportional_V_per_A, tuning_->gains->integral_V_per_As,
        margin_deg));
    findings_->details["board"] = tuning_->board_name;
    findings_->details["bandwidth_Hz"] = tuning_->options.bandwidth_Hz;
    findings_->details["proportional_gain_V_per_A"] = tuning_->gains->proportional_V_per_A;
    findings_->details["integral_gain_V_per_As"] = tuning_->gains->integral_V_per_As;
    findings_->details["phase_margin_deg"] = margin_deg;
  }

  static std::vector<device::ParameterChange> gains_of(const SuggestedGains& gains) {
    return {{Parameter::current_proportional_gain_V_per_A, static_cast<float>(gains.proportional_V_per_A)},
            {Parameter::current_integral_gain_V_per_As, static_cast<float>(gains.integral_V_per_As)}};
  }
  Parameter resistance_of(std::size_t index) const {
    return of_number(Parameter::motor_resistance_1_ohm, tuning_->options.motors[index]);
  }
  bool holds_suggested(const ParameterSet& set) const {
    return std::ranges::all_of(gains_of(*tuning_->gains),
                               [&](const auto& change) { return set[change.first] == change.second; });
  }

  void propose() {
    for (std::size_t i = 0; i < tuning_->after.size(); ++i) {
      const auto& before = tuning_->before[i];
      const auto& after = tuning_->after[i];
      findings_->sentences.push_back(fmt::format(
          "Motor {}, step of {:.1f} A: 63 % after {:.0f} us (before {:.0f} us), overshoot {:.1f} % (before {:.1f} "
          "%), steady error {:.1f} mA (before {:.1f} mA).",
          tuning_->options.motors[i], after.amplitude_A, 1e6 * after.rise_time_s, 1e6 * before.rise_time_s,
          1e2 * after.overshoot, 1e2 * before.overshoot, tenths(1e3 * after.steady_error_A),
          tenths(1e3 * before.steady_error_A)));
    }
    const std::string reason = fmt::format("for a bandwidth of {:.0f} Hz", tuning_->options.bandwidth_Hz);
    findings_->propose(old_, Parameter::current_proportional_gain_V_per_A, tuning_->gains->proportional_V_per_A,
                       reason);
    findings_->propose(old_, Parameter::current_integral_gain_V_per_As, tuning_->gains->integral_V_per_As, reason);
    if (tuning_->board == nullptr)
      findings_->sentences.push_back(fmt::format(
          "{}, so the shunts are unknown and no resistance is proposed. Subtract the shunt from each measured "
          "resistance, and set motor_resistance_1_ohm and the resistances of the other motors yourself.",
          tuning_->board_name.empty() ? std::string("The firmware does not report its board")
                                      : fmt::format("This companion does not know the board {}, but {}",
                                                    tuning_->board_name, board::names_of_boards())));
    for (std::size_t i = 0; i < tuning_->motors.size(); ++i)
      if (const auto motor_ohm = tuning_->motor_ohm(tuning_->motors[i]))
        findings_->propose(old_, resistance_of(i), to_four_digits(*motor_ohm), "used by the motor check");
    if (!has_measured_all_motors() || old_[Parameter::motors_confirmed] == 1.0f) return;
    findings_->propose(old_, Parameter::motors_confirmed, 1.0, "all motors are installed and measured");
    findings_->sentences.push_back(
        "Compare the resistances with the data sheets or a meter. After you apply the proposals, run `inkwell "
        "self-test`: then the motors receive current for the force.");
  }

  /// A motor with the current limit 0 is not used.
  bool has_measured_all_motors() const {
    for (const int motor : {1, 2, 3}) {
      const bool is_used = old_[of_number(Parameter::current_limit_1_A, motor)] > 0.0f;
      if (is_used && std::ranges::find(tuning_->options.motors, motor) == tuning_->options.motors.end()) return false;
    }
    return tuning_->board != nullptr;
  }

  std::shared_ptr<Tuning> tuning_;
  std::shared_ptr<Findings> findings_;
  bool suggested_;
  ParameterSet old_{};
  bool lent_ = false;
  Stopwatch since_;
  std::optional<PulseRecorder> recorder_;
};

Plan plan_current_loop(const Choices& choices) {
  Plan plan;
  auto tuning = std::make_shared<Tuning>(choices.current_loop);
  plan.steps.push_back(std::make_unique<RestInInkwell>(plan.findings, false));
  for (const int motor : tuning->options.motors)
    plan.steps.push_back(std::make_unique<IdentifyMotor>(tuning, plan.findings, motor));
  plan.steps.push_back(std::make_unique<TryGains>(tuning, plan.findings, false));
  plan.steps.push_back(std::make_unique<TryGains>(tuning, plan.findings, true));
  return plan;
}

}  // namespace

const Offer current_loop_guide{
    "tune", "current-loop", "Current-loop tuning",
    "Measures resistance and inductance of the motors, proposes the resistances, and tries gains "
    "for a bandwidth.",
    plan_current_loop};

}  // namespace inkwell::guides
