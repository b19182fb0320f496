// Calibration of the joints with their stops.
#include "host/client/guides/guides.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "host/client/guides/calibration_fits.hpp"

#include "host/client/guides/user_moves.hpp"

namespace inkwell::guides {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;

struct StopsFound {
  /// Returns all joint angles at the lower or upper stop of the joint with this index.
  std::array<Angles, 3> low{}, high{};
};

class MoveJointToStops final : public UserMoves {
 public:
  MoveJointToStops(std::shared_ptr<StopsFound> found, int joint) : found_(std::move(found)), joint_(joint) {}
  std::string title() const override { return fmt::format("Stops of joint {}, {}", joint_, joint_name(joint_)); }
  std::string text() const override {
    return fmt::format(
        "Move joint {}, {}, gently against one stop and hold it there for half a second. Do the same at the other "
        "stop. Keep the other joints away from their stops. Then press button 1. No current flows.",
        joint_, joint_name(joint_));
  }
  UserTask user_task() const override { return {UserTask::Kind::move_joint_to_stops, joint_}; }
  std::vector<Check> checks() const override {
    const bool rested = least_rad_ <= most_rad_;
    return {
        {fmt::format("joint {} now", joint_), now_rad_, "rad", "", true},
        {"rested at the lowest at", rested ? least_rad_ : 0, "rad", fmt::format("{:.3f}", expected_.low_rad), rested},
        {"rested at the highest at", rested ? most_rad_ : 0, "rad", fmt::format("{:.3f}", expected_.high_rad),
         is_complete()}};
  }

 protected:
  void observe(const Observation& now, double time_s) override {
    constexpr double still_rad = 0.003, rest_s = 0.3;
    const auto& set = *now.parameters;
    expected_ = {value(set, protocol::lower_stops, joint_), value(set, protocol::upper_stops, joint_)};
    Angles joints{};
    for (std::size_t i = 0; i < 3; ++i) joints[i] = static_cast<double>(now.pose->joint_rad[i]);
    // The elbow stops act between the links; see control::elbow_rad.
    now_rad_ = joints[static_cast<std::size_t>(joint_ - 1)];
    if (joint_ == 3 && set[Parameter::transmission] == 1.0f) now_rad_ -= joints[1];
    if (std::abs(now_rad_ - anchor_rad_) > still_rad) {
      anchor_rad_ = now_rad_;
      anchored_at_s_ = time_s;
    }
    if (time_s - anchored_at_s_ < rest_s) return;
    const auto index = static_cast<std::size_t>(joint_ - 1);
    if (now_rad_ < least_rad_) {
      least_rad_ = now_rad_;
      found_->low[index] = joints;
    }
    if (now_rad_ > most_rad_) {
      most_rad_ = now_rad_;
      found_->high[index] = joints;
    }
  }
  /// A tenth of the expected travel is enough, because a wrong counts-per-turn value reduces the measured travel.
  bool is_complete() const override { return most_rad_ - least_rad_ > expected_.width_rad() / 10; }
  void take(const Observation&) override {}
  std::string too_late() const override {
    return fmt::format("Joint {} was not moved to both its stops in two minutes. Start the guide again.", joint_);
  }

 private:
  std::shared_ptr<StopsFound> found_;
  int joint_;
  JointStops expected_{};
  double now_rad_ = 0, anchor_rad_ = 1e9, anchored_at_s_ = 0;
  double least_rad_ = std::numeric_limits<double>::infinity(), most_rad_ = -std::numeric_limits<double>::infinity();
};

class CompareStops final : public Step {
 public:
  CompareStops(std::shared_ptr<Findings> findings, std::shared_ptr<StopsFound> found, StopsTrust trust)
      : findings_(std::move(findings)), found_(std::move(found)), trust_(trust) {}
  std::string title() const override { return "Comparison with the limits"; }
  std::string text() const override { return "The measured stops are compared with the arm's limits."; }

  bool advance(const Observation& now, DevicePort&) override {
    const ParameterSet& set = *now.parameters;
    // Joint 3 of a parallelogram is absolute. The stops of joint 3 move with joint 2, which is corrected first.
    for (int joint = 1; joint <= 3; ++joint) {
      const auto index = static_cast<std::size_t>(joint - 1);
      const bool relative = joint == 3 && set[Parameter::transmission] == 1.0f;
      const JointStops found{found_->low[index][index], found_->high[index][index]};
      JointStops expected{value(set, protocol::lower_stops, joint), value(set, protocol::upper_stops, joint)};
      if (relative) {
        expected.low_rad += corrected_shoulder_rad(set, found_->low[2][1]);
        expected.high_rad += corrected_shoulder_rad(set, found_->high[2][1]);
      }
      judge(set, joint, found, expected,
            relative ? JointStops{found_->low[2][1], found_->high[2][1]} : JointStops{0, 0});
    }
    return true;
  }

 private:
  double corrected_shoulder_rad(const ParameterSet& set, double angle_rad) const {
    const double inkwell_rad = value(set, Parameter::inkwell_joint_1_rad, 2);
    return shoulder_.inkwell_rad + shoulder_.scale * (angle_rad - inkwell_rad);
  }

  void judge(const ParameterSet& set, int joint, const JointStops& found, const JointStops& expected,
             const JointStops& base) {
    const double inkwell_rad = value(set, Parameter::inkwell_joint_1_rad, joint);
    StopsFit fit = fit_stops(found, expected, inkwell_rad, false);
    const bool width_agrees = std::abs(found.width_rad() - expected.width_rad()) <= stops_tolerance_rad;
    const bool position_agrees = std::abs(fit.inkwell_rad - inkwell_rad) <= stops_tolerance_rad;
    const bool trusts_limits = trust_ == StopsTrust::limits;
    if (!width_agrees && trusts_limits) fit = fit_stops(found, expected, inkwell_rad, true);
    if (joint == 2) shoulder_ = width_agrees && position_agrees ? StopsFit{1, inkwell_rad, 0, 0} : fit;
    if (joint == 2 && !trusts_limits) shoulder_ = {1, inkwell_rad, 0, 0};

    findings_->sentences.push_back(
        fmt::format("Joint {}: stops at {:.3f} and {:.3f} rad, expected {:.3f} and {:.3f}: {}", joint, found.low_rad,
                    found.high_rad, expected.low_rad, expected.high_rad,
                    width_agrees && position_agrees ? "they agree."
                    : width_agrees                  ? "the travel agrees, but its position differs."
                                                    : "the travel differs."));
    findings_->details["joints"].push_back({{"joint", joint},
                                            {"found_rad", {found.low_rad, found.high_rad}},
                                            {"expected_rad", {expected.low_rad, expected.high_rad}},
                                            {"agrees", width_agrees && position_agrees}});
    if (width_agrees && position_agrees) return;
    if (!trusts_limits) {
      findings_->propose(set, of_number(protocol::lower_stops, joint), found.low_rad - base.low_rad,
                         "the lower stop was found here");
      findings_->propose(set, of_number(protocol::upper_stops, joint), found.high_rad - base.high_rad,
                         "the upper stop was found here");
      return;
    }
    if (!width_agrees) {
      // An encoder has four counts per line. Compliant stops cause an error of about 1 %, so the encoder's data sheet
      // is more accurate.
      const double counts = value(set, Parameter::encoder_1_counts_per_turn, joint) / fit.scale;
      findings_->propose(set, of_number(Parameter::encoder_1_counts_per_turn, joint), 4 * std::round(counts / 4),
                         fmt::format("the measured travel is {:.2f} times the expected travel; if the encoder's data "
                                     "sheet has a similar value, prefer it",
                                     1 / fit.scale));
    }
    if (std::abs(fit.inkwell_rad - inkwell_rad) > stops_tolerance_rad)
      findings_->propose(set, of_number(Parameter::inkwell_joint_1_rad, joint), fit.inkwell_rad,
                         "moves the stops to the limits");
  }

  std::shared_ptr<Findings> findings_;
  std::shared_ptr<StopsFound> found_;
  StopsTrust trust_;
  StopsFit shoulder_{1, 0, 0, 0};
};

Plan plan_stops(const Choices& choices) {
  Plan plan;
  auto found = std::make_shared<StopsFound>();
  plan.steps.push_back(std::make_unique<RestInInkwell>(plan.findings, false));
  for (int joint = 1; joint <= 3; ++joint) plan.steps.push_back(std::make_unique<MoveJointToStops>(found, joint));
  plan.steps.push_back(std::make_unique<CompareStops>(plan.findings, found, choices.trust));
  return plan;
}

}  // namespace

const Offer stops_guide{"calibrate", "stops", "Joint stops",
                        "You move each joint to both its stops; they are compared with the limits.", plan_stops};

}  // namespace inkwell::guides
