// Calibration: inkwell, joint stops, potentiometers of the gimbal.
#include <guides/guides.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <fmt/format.h>

#include <guides/calibration_fits.hpp>

#include "joint_motion.hpp"

namespace inkwell::guides {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;
using Angles = std::array<double, 3>;

double value(const ParameterSet& set, Parameter first, int number, int stride = 1) {
  return static_cast<double>(set[parameter_of(first, number, stride)]);
}

/// The user does something with the arm or the stylus and says so with Confirm or with button 1.
class UserMoves : public Step {
 public:
  void begin(const Observation& now, DevicePort&) override { since_.start(*now.pose); }
  bool takes_confirmation() const override { return true; }
  void confirm() override { confirmed_ = true; }

  bool advance(const Observation& now, DevicePort&) override {
    const bool pressed = is_closed(*now.pose, protocol::Switch::button_1);
    if (pressed && !was_pressed_) confirmed_ = true;
    was_pressed_ = pressed;
    if (since_.seconds(*now.pose) > user_limit_s) throw device::Error(too_late());
    look(now, since_.seconds(*now.pose));
    if (!confirmed_) return false;
    confirmed_ = false;
    if (!is_complete()) return false;
    take(now);
    return true;
  }

 protected:
  virtual void look(const Observation& now, double time_s) = 0;
  virtual bool is_complete() const = 0;
  virtual void take(const Observation& now) = 0;
  virtual std::string too_late() const = 0;

 private:
  Stopwatch since_;
  bool confirmed_ = false, was_pressed_ = true;  // a button held down from before does not count
};

// ---- joint stops -------------------------------------------------------------------------------------------

struct StopsFound {
  /// All joints while the one that the place stands for rested at its lower and at its upper stop.
  std::array<Angles, 3> low{}, high{};
};

class MoveJointToStops final : public UserMoves {
 public:
  MoveJointToStops(std::shared_ptr<StopsFound> found, int joint) : found_(std::move(found)), joint_(joint) {}
  std::string title() const override { return fmt::format("Stops of joint {}, {}", joint_, joint_name(joint_)); }
  std::string text() const override {
    return fmt::format(
        "Move joint {}, {}, gently against its one stop, hold it there for half a second, and then against "
        "the other. The other joints stay away from theirs. Press button 1 when both are done. No current "
        "flows.",
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
  void look(const Observation& now, double time_s) override {
    constexpr double still_rad = 0.003, rest_s = 0.3;
    const auto& set = *now.parameters;
    expected_ = {value(set, Parameter::joint_1_minimum_rad, joint_, 2),
                 value(set, Parameter::joint_1_maximum_rad, joint_, 2)};
    Angles joints{};
    for (std::size_t i = 0; i < 3; ++i) joints[i] = static_cast<double>(now.pose->joint_rad[i]);
    // The elbow's stops lie between the links; see control::elbow_rad.
    now_rad_ = joints[static_cast<std::size_t>(joint_ - 1)];
    if (joint_ == 3 && set[Parameter::transmission] == 1.0f) now_rad_ -= joints[1];
    if (std::abs(now_rad_ - anchor_rad_) > still_rad) {
      anchor_rad_ = now_rad_;
      anchored_at_s_ = time_s;
    }
    if (time_s - anchored_at_s_ < rest_s) return;
    const auto place = static_cast<std::size_t>(joint_ - 1);
    if (now_rad_ < least_rad_) {
      least_rad_ = now_rad_;
      found_->low[place] = joints;
    }
    if (now_rad_ > most_rad_) {
      most_rad_ = now_rad_;
      found_->high[place] = joints;
    }
  }
  /// A tenth of the expected travel: encoders with a wrong number of counts show less than there is.
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

/// Compares what was found with the limits.
class CompareStops final : public Step {
 public:
  CompareStops(std::shared_ptr<Findings> findings, std::shared_ptr<StopsFound> found, StopsTrust trust)
      : findings_(std::move(findings)), found_(std::move(found)), trust_(trust) {}
  std::string title() const override { return "Comparison with the limits"; }
  std::string text() const override { return "The stops that were found are compared with the arm's limits."; }

  bool advance(const Observation& now, DevicePort&) override {
    const ParameterSet& set = *now.parameters;
    // Joint 3 of a parallelogram is absolute: its stops move with joint 2, which is corrected before it.
    for (int joint = 1; joint <= 3; ++joint) {
      const auto place = static_cast<std::size_t>(joint - 1);
      const bool relative = joint == 3 && set[Parameter::transmission] == 1.0f;
      const JointStops found{found_->low[place][place], found_->high[place][place]};
      JointStops expected{value(set, Parameter::joint_1_minimum_rad, joint, 2),
                          value(set, Parameter::joint_1_maximum_rad, joint, 2)};
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
    const bool place_agrees = std::abs(fit.inkwell_rad - inkwell_rad) <= stops_tolerance_rad;
    const bool trusts_limits = trust_ == StopsTrust::limits;
    if (!width_agrees && trusts_limits) fit = fit_stops(found, expected, inkwell_rad, true);
    if (joint == 2) shoulder_ = width_agrees && place_agrees ? StopsFit{1, inkwell_rad, 0, 0} : fit;
    if (joint == 2 && !trusts_limits) shoulder_ = {1, inkwell_rad, 0, 0};

    findings_->sentences.push_back(
        fmt::format("Joint {}: stops at {:.3f} and {:.3f} rad, expected {:.3f} and {:.3f}: {}", joint, found.low_rad,
                    found.high_rad, expected.low_rad, expected.high_rad,
                    width_agrees && place_agrees ? "they agree."
                    : width_agrees               ? "the travel agrees but lies elsewhere."
                                                 : "the travel differs."));
    findings_->details["joints"].push_back({{"joint", joint},
                                            {"found_rad", {found.low_rad, found.high_rad}},
                                            {"expected_rad", {expected.low_rad, expected.high_rad}},
                                            {"agrees", width_agrees && place_agrees}});
    if (width_agrees && place_agrees) return;
    if (!trusts_limits) {
      findings_->propose(set, parameter_of(Parameter::joint_1_minimum_rad, joint, 2), found.low_rad - base.low_rad,
                         "the lower stop was found here");
      findings_->propose(set, parameter_of(Parameter::joint_1_maximum_rad, joint, 2), found.high_rad - base.high_rad,
                         "the upper stop was found here");
      return;
    }
    if (!width_agrees) {
      // Four counts a line; stops that yield leave about a hundredth open, which the encoder's data sheet settles.
      const double counts = value(set, Parameter::encoder_1_counts_per_turn, joint) / fit.scale;
      findings_->propose(
          set, parameter_of(Parameter::encoder_1_counts_per_turn, joint), 4 * std::round(counts / 4),
          fmt::format("the travel was found {:.2f} times as wide as it is; prefer the encoder's data sheet "
                      "where it is near",
                      1 / fit.scale));
    }
    if (std::abs(fit.inkwell_rad - inkwell_rad) > stops_tolerance_rad)
      findings_->propose(set, parameter_of(Parameter::inkwell_joint_1_rad, joint), fit.inkwell_rad,
                         "then the stops lie at the limits");
  }

  std::shared_ptr<Findings> findings_;
  std::shared_ptr<StopsFound> found_;
  StopsTrust trust_;
  StopsFit shoulder_{1, 0, 0, 0};
};

// ---- potentiometers ----------------------------------------------------------------------------------------

const char* axis_name(int axis) {
  constexpr const char* names[] = {"yaw", "pitch", "roll"};
  return names[axis - 1];
}

constexpr int rows_per_axis = 3;

PotentiometerCurve held_curve(const ParameterSet& set, int axis) {
  return {value(set, Parameter::gimbal_1_square_rad, axis, rows_per_axis),
          value(set, Parameter::gimbal_1_slope_rad, axis, rows_per_axis),
          value(set, Parameter::gimbal_1_offset_rad, axis, rows_per_axis)};
}

/// What the arm's description says of the whole track.
AngleRange described_range(int axis) {
  const auto curve = held_curve(protocol::default_parameters(), axis);
  return {std::min(curve.angle_rad(0), curve.angle_rad(1)), std::max(curve.angle_rad(0), curve.angle_rad(1))};
}

struct AxisPoints {
  AngleRange range{};
  double least_ratio = std::numeric_limits<double>::infinity(), most_ratio = -std::numeric_limits<double>::infinity();
  double middle_ratio = 0.5;
};

/// The mean over the last reports: the wiper is noisy. Counts time, not reports, of which a window sees fewer.
class Smoothed {
 public:
  void take(double ratio, double time_s) {
    if (recent_.empty()) began_at_s_ = time_s;
    recent_.push_back({time_s, ratio});
    while (time_s - recent_.front().first > window_s) recent_.pop_front();
    is_full_ = time_s - began_at_s_ >= window_s;
  }
  bool is_full() const { return is_full_; }
  double mean() const {
    double sum = 0;
    for (const auto& [time_s, ratio] : recent_) sum += ratio;
    return recent_.empty() ? 0 : sum / static_cast<double>(recent_.size());
  }

 private:
  static constexpr double window_s = 0.04;
  std::deque<std::pair<double, double>> recent_;
  double began_at_s_ = 0;
  bool is_full_ = false;
};

class TurnGimbal final : public UserMoves {
 public:
  TurnGimbal(std::shared_ptr<AxisPoints> points, int axis, bool middle)
      : points_(std::move(points)), axis_(axis), middle_(middle) {}
  std::string title() const override {
    return fmt::format("Potentiometer {}, {}{}", axis_, axis_name(axis_), middle_ ? ", middle" : "");
  }
  std::string text() const override {
    if (middle_)
      return fmt::format(
          "Turn the stylus' {} to {:.3f} rad, the middle of its range, hold it there and press button 1.",
          axis_name(axis_), (points_->range.minimum_rad + points_->range.maximum_rad) / 2);
    return fmt::format(
        "Turn the stylus' {} to both its stops, at {:.3f} and {:.3f} rad, and hold it at each for a moment. "
        "Press button 1 when both are done. No current flows.",
        axis_name(axis_), points_->range.minimum_rad, points_->range.maximum_rad);
  }
  UserTask user_task() const override {
    return {middle_ ? UserTask::Kind::centre_gimbal : UserTask::Kind::turn_gimbal_to_stops, axis_};
  }
  std::vector<Check> checks() const override {
    std::vector<Check> checks{
        {fmt::format("{} potentiometer now", axis_name(axis_)), smoothed_.mean(), "of its supply", "", true}};
    if (middle_ || points_->least_ratio > points_->most_ratio) return checks;
    checks.push_back({"least", points_->least_ratio, "of its supply", "", is_complete()});
    checks.push_back({"most", points_->most_ratio, "of its supply", "", is_complete()});
    return checks;
  }

 protected:
  void look(const Observation& now, double time_s) override {
    if (now.pose->sequence == sequence_) return;
    sequence_ = now.pose->sequence;
    smoothed_.take(held_curve(*now.parameters, axis_).ratio(static_cast<double>(now.pose->gimbal_rad[axis_ - 1])),
                   time_s);
    if (middle_ || !smoothed_.is_full()) return;
    points_->least_ratio = std::min(points_->least_ratio, smoothed_.mean());
    points_->most_ratio = std::max(points_->most_ratio, smoothed_.mean());
  }
  bool is_complete() const override {
    return middle_ ? smoothed_.is_full() : points_->most_ratio - points_->least_ratio > 0.1;
  }
  void take(const Observation&) override {
    if (middle_) points_->middle_ratio = smoothed_.mean();
  }
  std::string too_late() const override {
    return fmt::format("The stylus' {} was not turned in two minutes. If it was, check its potentiometer's plug.",
                       axis_name(axis_));
  }

 private:
  std::shared_ptr<AxisPoints> points_;
  int axis_;
  bool middle_;
  Smoothed smoothed_;
  std::uint32_t sequence_ = 0;
};

class FitPotentiometers final : public Step {
 public:
  FitPotentiometers(std::shared_ptr<Findings> findings, std::vector<std::shared_ptr<AxisPoints>> axes, bool quadratic)
      : findings_(std::move(findings)), axes_(std::move(axes)), quadratic_(quadratic) {}
  std::string title() const override { return "Fit"; }
  std::string text() const override { return "A curve is laid through the points of each potentiometer."; }

  bool advance(const Observation& now, DevicePort&) override {
    for (int axis = 1; axis <= 3; ++axis) fit(*now.parameters, axis, *axes_[static_cast<std::size_t>(axis - 1)]);
    return true;
  }

 private:
  void fit(const ParameterSet& set, int axis, const AxisPoints& points) {
    const PotentiometerCurve held = held_curve(set, axis);
    const bool falling = held.slope_rad < 0;
    std::vector<PotentiometerPoint> given{
        {points.least_ratio, falling ? points.range.maximum_rad : points.range.minimum_rad},
        {points.most_ratio, falling ? points.range.minimum_rad : points.range.maximum_rad}};
    if (quadratic_) given.push_back({points.middle_ratio, (points.range.minimum_rad + points.range.maximum_rad) / 2});
    const PotentiometerCurve curve = fit_potentiometer(given, quadratic_);
    double largest_change_rad = 0;
    for (double ratio = points.least_ratio; ratio <= points.most_ratio;
         ratio += (points.most_ratio - points.least_ratio) / 50)
      largest_change_rad = std::max(largest_change_rad, std::abs(curve.angle_rad(ratio) - held.angle_rad(ratio)));
    // A hundredth of a radian is what wiper noise and a hand at the stop leave open.
    constexpr double tolerance_rad = 0.01;
    const bool agrees = largest_change_rad <= tolerance_rad;
    findings_->sentences.push_back(
        fmt::format("Gimbal {}, {}: wiper from {:.4f} to {:.4f} of its supply; angle = {:.4f} r^2 + {:.4f} r + {:.4f} "
                    "rad, {:.3f} rad off what the "
                    "device holds at most{}.",
                    axis, axis_name(axis), points.least_ratio, points.most_ratio, curve.square_rad, curve.slope_rad,
                    curve.offset_rad, largest_change_rad, agrees ? ", so it is kept" : ""));
    findings_->details["potentiometers"].push_back({{"axis", axis},
                                                    {"ratio", {points.least_ratio, points.most_ratio}},
                                                    {"square_rad", curve.square_rad},
                                                    {"slope_rad", curve.slope_rad},
                                                    {"offset_rad", curve.offset_rad},
                                                    {"largest_change_rad", largest_change_rad},
                                                    {"agrees", agrees}});
    if (agrees) return;
    const std::string reason =
        fmt::format("fits the {} stops of the {}", quadratic_ ? "middle and the" : "two", axis_name(axis));
    findings_->propose(set, parameter_of(Parameter::gimbal_1_square_rad, axis, rows_per_axis), curve.square_rad,
                       reason);
    findings_->propose(set, parameter_of(Parameter::gimbal_1_slope_rad, axis, rows_per_axis), curve.slope_rad, reason);
    findings_->propose(set, parameter_of(Parameter::gimbal_1_offset_rad, axis, rows_per_axis), curve.offset_rad,
                       reason);
  }

  std::shared_ptr<Findings> findings_;
  std::vector<std::shared_ptr<AxisPoints>> axes_;
  bool quadratic_;
};

}  // namespace

Guide inkwell_guide() {
  auto findings = std::make_shared<Findings>();
  std::vector<std::unique_ptr<Step>> steps;
  steps.push_back(std::make_unique<RestInInkwell>(findings, true));
  return {"inkwell", "Reference in the inkwell", std::move(steps), findings};
}

Guide stops_guide(StopsTrust trust) {
  auto findings = std::make_shared<Findings>();
  auto found = std::make_shared<StopsFound>();
  std::vector<std::unique_ptr<Step>> steps;
  steps.push_back(std::make_unique<RestInInkwell>(findings, false));
  for (int joint = 1; joint <= 3; ++joint) steps.push_back(std::make_unique<MoveJointToStops>(found, joint));
  steps.push_back(std::make_unique<CompareStops>(findings, found, trust));
  return {"stops", "Joint stops", std::move(steps), findings};
}

Guide potentiometer_guide(const PotentiometerOptions& options) {
  auto findings = std::make_shared<Findings>();
  std::vector<std::shared_ptr<AxisPoints>> axes;
  std::vector<std::unique_ptr<Step>> steps;
  for (int axis = 1; axis <= 3; ++axis) {
    auto points = std::make_shared<AxisPoints>();
    points->range = options.range[static_cast<std::size_t>(axis - 1)].value_or(described_range(axis));
    steps.push_back(std::make_unique<TurnGimbal>(points, axis, false));
    if (options.quadratic) steps.push_back(std::make_unique<TurnGimbal>(points, axis, true));
    axes.push_back(std::move(points));
  }
  steps.push_back(std::make_unique<FitPotentiometers>(findings, axes, options.quadratic));
  return {"pots", "Potentiometers of the gimbal", std::move(steps), findings};
}

}  // namespace inkwell::guides
