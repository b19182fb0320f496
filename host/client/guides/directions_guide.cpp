// Directions: checks each encoder and each motor.
#include "host/client/guides/guides.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/client/guides/pulse_recorder.hpp"

#include "host/client/guides/joint_motion.hpp"
#include "host/client/guides/pulse_size.hpp"

namespace inkwell::guides {
namespace {

using protocol::Parameter;
using protocol::Signal;

constexpr float pulse_s = 0.06f, pulse_A = 0.4f;
constexpr double smallest_turn_rad = 0.004;

class PulseMotor final : public Step {
 public:
  PulseMotor(std::shared_ptr<Findings> findings, std::shared_ptr<ReversedEncoders> reversed, int motor)
      : findings_(std::move(findings)), reversed_(std::move(reversed)), motor_(motor) {}

  std::string title() const override { return fmt::format("Motor {}, {}", motor_, joint_name(motor_)); }
  std::string text() const override {
    return fmt::format(
        "Hold the stylus loosely, just outside the inkwell. Motor {} receives a pulse of at most {:.1f} A for {:.0f} "
        "ms forward, then the same pulse backward; {} twitches by about a centimeter. The wall force stays off.",
        motor_, pulse_A, 1e3f * pulse_s, joint_name(motor_));
  }
  bool needs_consent() const override { return true; }
  UserTask user_task() const override { return {UserTask::Kind::hold_loosely, motor_}; }

  void begin(const Observation& now, DevicePort&) override {
    const auto& set = *now.parameters;
    amplitude_A_ =
        std::min({pulse_A, 0.5f * set[of_number(Parameter::current_limit_1_A, motor_)], allowed_pulse_A(set, motor_)});
    since_.start(*now.pose);
  }
  void receive(const device::ScopeSamples& samples) override {
    if (recorder_) recorder_->receive(samples);
  }

  bool advance(const Observation& now, DevicePort& port) override {
    if (!recorder_) {
      if (!holds_still(*now.pose)) return false;
      start_pulse(now, port);
    }
    if (!recorder_->advance(*now.pose, port)) return false;
    turned_rad_.push_back(measured_turn_rad());
    if (turned_rad_.size() == 1) {
      start_pulse(now, port);
      return false;
    }
    judge(now);
    return true;
  }

  std::vector<Check> checks() const override {
    std::vector<Check> checks;
    const char* names[] = {"joint {} turned by, pulse forward", "joint {} turned by, pulse back"};
    for (std::size_t i = 0; i < turned_rad_.size(); ++i)
      checks.push_back({fmt::format(fmt::runtime(names[i]), motor_), turned_rad_[i], "rad", i == 0 ? "forward" : "back",
                        (turned_rad_[i] > 0) == (i == 0)});
    return checks;
  }
  double progress() const override { return static_cast<double>(turned_rad_.size()) / 2; }

 private:
  /// Returns true if the stylus is out of the inkwell and the joint is nearly stationary.
  bool holds_still(const device::Pose& pose) {
    const double angle_rad = static_cast<double>(pose.joint_rad[motor_ - 1]);
    if (is_closed(pose.switches, protocol::Switch::inkwell) ||
        std::abs(angle_rad - anchor_rad_) > smallest_turn_rad / 4) {
      anchor_rad_ = angle_rad;
      still_.start(pose);
    }
    if (since_.seconds(pose) > user_limit_s)
      throw device::Error("The stylus was not held still outside the inkwell. Start the guide again.");
    return still_.seconds(pose) > 0.5;
  }

  void start_pulse(const Observation& now, DevicePort& port) {
    const float amplitude_A = turned_rad_.empty() ? amplitude_A_ : -amplitude_A_;
    recorder_.emplace(
        protocol::Command::test_current, protocol::TestPulse{static_cast<std::uint8_t>(motor_), amplitude_A, pulse_s},
        std::vector<Signal>{of_number(Signal::current_reference_1_A, motor_), of_number(Signal::current_1_A, motor_),
                            of_number(Signal::joint_1_rad, motor_)},
        of_number(Signal::current_reference_1_A, motor_));
    recorder_->begin(*now.pose, port);
  }

  double measured_turn_rad() {
    const auto reference_A = recorder_->values_of(of_number(Signal::current_reference_1_A, motor_));
    const auto current_A = recorder_->values_of(of_number(Signal::current_1_A, motor_));
    const auto joint_rad = recorder_->values_of(of_number(Signal::joint_1_rad, motor_));
    const auto is_on = [](double reference) { return reference != 0; };
    const auto begin = static_cast<std::size_t>(std::ranges::find_if(reference_A, is_on) - reference_A.begin());
    std::size_t end = begin;
    double requested_A = 0, measured_A = 0;
    for (; end < reference_A.size() && is_on(reference_A[end]); ++end) {
      requested_A += reference_A[end];
      measured_A += current_A[end];
    }
    if (std::abs(measured_A - requested_A) > 0.3 * std::abs(requested_A))
      throw device::Error(
          fmt::format("The current of motor {} does not follow its reference. Check the motor's plug and "
                      "wiring, then tune the current loops.",
                      motor_));
    return joint_rad[end - 1] - joint_rad[begin];
  }

  /// The effects of hand and gravity are the same in both pulses and cancel in the difference.
  void judge(const Observation& now) {
    const double difference_rad = turned_rad_[0] - turned_rad_[1];
    if (std::abs(difference_rad) < smallest_turn_rad)
      throw device::Error(
          fmt::format("Joint {} did not turn. Hold the stylus more loosely. Check that the transmission cable is on "
                      "its capstan, and that energy_reserve_J ({:.3f} J), which limits a pulse, is not far below its "
                      "default. Then start the guide again.",
                      motor_, (*now.parameters)[Parameter::energy_reserve_J]));
    const auto index = static_cast<std::size_t>(motor_ - 1);
    const bool encoder_wrong = (*reversed_)[index].value_or(false);
    const bool forward = (difference_rad > 0) != encoder_wrong;
    const auto parameter = of_number(Parameter::motor_1_reversed, motor_);
    const bool held_reversed = (*now.parameters)[parameter] == 1.0f;
    // A test pulse sets the motor current directly and ignores motor_n_reversed.
    const bool right = forward != held_reversed;
    findings_->sentences.push_back(fmt::format("A positive current turns joint {} {}, {}.", motor_,
                                               forward ? "forward" : "backward",
                                               right ? "as the parameters state" : "which contradicts the parameters"));
    findings_->details["motors"].push_back({{"motor", motor_},
                                            {"turned_by_positive_current_rad", turned_rad_[0]},
                                            {"turned_by_negative_current_rad", turned_rad_[1]},
                                            {"turns_forward", forward}});
    if (!right)
      findings_->propose(
          *now.parameters, parameter, forward ? 0.0 : 1.0,
          fmt::format("a positive current turned joint {} {}", motor_, forward ? "forward" : "backward"));
  }

  std::shared_ptr<Findings> findings_;
  std::shared_ptr<ReversedEncoders> reversed_;
  int motor_;
  float amplitude_A_ = pulse_A;
  double anchor_rad_ = 1e9;
  Stopwatch since_, still_;
  std::optional<PulseRecorder> recorder_;
  std::vector<double> turned_rad_;
};

Plan plan_directions(const Choices&) {
  Plan plan;
  auto reversed = std::make_shared<ReversedEncoders>();
  plan.steps.push_back(std::make_unique<RestInInkwell>(plan.findings, false));
  for (int joint = 1; joint <= 3; ++joint)
    plan.steps.push_back(std::make_unique<TurnJointForward>(plan.findings, reversed, joint));
  for (int motor = 1; motor <= 3; ++motor)
    plan.steps.push_back(std::make_unique<PulseMotor>(plan.findings, reversed, motor));
  return plan;
}

}  // namespace

const Offer directions_guide{
    "check", "directions", "Directions",
    "Checks each encoder while you turn its joint, then each motor with a small current pulse.", plan_directions};

}  // namespace inkwell::guides
