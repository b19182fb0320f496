// First connection: checks all parts and the directions of the encoders.
#include "host/client/guides/guides.hpp"

#include <fmt/format.h>

#include "boards/facts/board_facts.hpp"

#include "host/client/guides/joint_motion.hpp"

namespace inkwell::guides {
namespace {

class LookAtDevice final : public Step {
 public:
  explicit LookAtDevice(std::shared_ptr<Findings> findings) : findings_(std::move(findings)) {}
  std::string title() const override { return "Versions, supply and state"; }
  std::string text() const override {
    return "Versions, supply and state are read from the device. Nothing moves and no current flows.";
  }
  void begin(const Observation& now, DevicePort&) override { since_.start(*now.pose); }

  bool advance(const Observation& now, DevicePort&) override {
    if (!now.information || since_.seconds(*now.pose) < 0.5) return false;
    const auto& information = *now.information;
    const auto& report = information.report;
    const double supply_V = now.pose->supply_dV / 10.0, load = now.pose->servo_load / 2.55;
    checks_ = {
        {"protocol version", static_cast<double>(information.protocol_version), "",
         fmt::format("{}", protocol::protocol_version), information.protocol_version == protocol::protocol_version},
        {"supply", supply_V, "V", fmt::format("{:.0f} to {:.0f}", board::supply_minimum_V, board::supply_maximum_V),
         supply_V >= static_cast<double>(board::supply_minimum_V) &&
             supply_V <= static_cast<double>(board::supply_maximum_V)},
        {"servo load", load, "%", "below 90", load < 90},
        {"servo overruns", static_cast<double>(report.servo_overruns), "", "0", report.servo_overruns == 0}};
    for (const auto& check : checks_)
      if (!check.passed)
        throw device::Error(fmt::format("{} is {:.1f}{}{}, expected {}. Correct it and start the guide again.",
                                        check.name, check.value, check.unit.empty() ? "" : " ", check.unit,
                                        check.expected));
    findings_->sentences.push_back(fmt::format(
        "Device {} with firmware {}, protocol {}; supply {:.1f} V, control interrupt "
        "uses {:.0f} % of its period.",
        information.serial_number, information.firmware_version, information.protocol_version, supply_V, load));
    findings_->details["device"] = {{"serial_number", information.serial_number},
                                    {"firmware_version", information.firmware_version},
                                    {"protocol_version", information.protocol_version},
                                    {"supply_V", supply_V},
                                    {"servo_load_percent", load},
                                    {"state", info(now.pose->state).name}};
    return true;
  }
  std::vector<Check> checks() const override { return checks_; }

 private:
  std::shared_ptr<Findings> findings_;
  Stopwatch since_;
  std::vector<Check> checks_;
};

class PressButton final : public Step {
 public:
  PressButton(std::shared_ptr<Findings> findings, int button) : findings_(std::move(findings)), button_(button) {}
  std::string title() const override { return fmt::format("Button {}", button_); }
  std::string text() const override { return fmt::format("Press and release button {} of the stylus.", button_); }
  UserTask user_task() const override { return {UserTask::Kind::press_button, button_}; }
  void begin(const Observation& now, DevicePort&) override { since_.start(*now.pose); }

  bool advance(const Observation& now, DevicePort&) override {
    const auto wanted = button_ == 1 ? protocol::Switch::button_1 : protocol::Switch::button_2;
    const auto other = button_ == 1 ? protocol::Switch::button_2 : protocol::Switch::button_1;
    now_pressed_ = is_closed(now.pose->switches, wanted);
    if (is_closed(now.pose->switches, other) && !now_pressed_)
      hint_ = "the other button is pressed. If you press the right button, the wires of the buttons are swapped";
    seen_ |= now_pressed_;
    if (since_.seconds(*now.pose) > user_limit_s)
      throw device::Error(fmt::format("Button {} was not pressed{}. Check its wiring and start the guide again.",
                                      button_, hint_.empty() ? "" : ": " + hint_));
    if (!seen_ || now_pressed_) return false;
    findings_->sentences.push_back(fmt::format("Button {} works.", button_));
    findings_->details["buttons"].push_back(button_);
    return true;
  }
  std::vector<Check> checks() const override {
    return {
        {fmt::format("button {}", button_), now_pressed_ ? 1.0 : 0.0, "", hint_.empty() ? "pressed" : hint_, seen_}};
  }

 private:
  std::shared_ptr<Findings> findings_;
  int button_;
  bool now_pressed_ = false, seen_ = false;
  std::string hint_;
  Stopwatch since_;
};

Plan plan_connection(const Choices&) {
  Plan plan;
  auto reversed = std::make_shared<ReversedEncoders>();
  plan.steps.push_back(std::make_unique<LookAtDevice>(plan.findings));
  plan.steps.push_back(std::make_unique<RestInInkwell>(plan.findings, true));
  for (int joint = 1; joint <= 3; ++joint)
    plan.steps.push_back(std::make_unique<TurnJointForward>(plan.findings, reversed, joint));
  for (int button = 1; button <= 2; ++button)
    plan.steps.push_back(std::make_unique<PressButton>(plan.findings, button));
  return plan;
}

}  // namespace

const Offer connection_guide{"check", "connection", "First connection",
                             "Versions, supply, inkwell, encoders and buttons. No current flows.", plan_connection};

}  // namespace inkwell::guides
