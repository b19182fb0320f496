// Calibration of the gimbal potentiometers.
#include "host/client/guides/guides.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
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

const char* axis_name(int axis) {
  constexpr const char* names[] = {"yaw", "pitch", "roll"};
  return names[axis - 1];
}

PotentiometerCurve held_curve(const ParameterSet& set, int axis) {
  return {value(set, Parameter::gimbal_1_square_rad, axis), value(set, Parameter::gimbal_1_slope_rad, axis),
          value(set, Parameter::gimbal_1_offset_rad, axis)};
}

/// Angle range of the full potentiometer track.
AngleRange described_range(int axis) {
  const auto curve = held_curve(protocol::default_parameters(), axis);
  return {std::min(curve.angle_rad(0), curve.angle_rad(1)), std::max(curve.angle_rad(0), curve.angle_rad(1))};
}

struct AxisPoints {
  AngleRange range{};
  double least_ratio = std::numeric_limits<double>::infinity(), most_ratio = -std::numeric_limits<double>::infinity();
  double middle_ratio = 0.5;
};

/// Mean of the latest reports, because the wiper is noisy. The averaging window has a fixed duration, because a program
/// may miss reports.
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
        "Turn the stylus' {} to both its stops, at {:.3f} and {:.3f} rad, and hold it at each stop for a moment. Then "
        "press button 1. No current flows.",
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
  void observe(const Observation& now, double time_s) override {
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
  std::int64_t sequence_ = 0;
};

class FitPotentiometers final : public Step {
 public:
  FitPotentiometers(std::shared_ptr<Findings> findings, std::vector<std::shared_ptr<AxisPoints>> axes, bool quadratic)
      : findings_(std::move(findings)), axes_(std::move(axes)), quadratic_(quadratic) {}
  std::string title() const override { return "Fit"; }
  std::string text() const override { return "A curve is fitted to the points of each potentiometer."; }

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
    // Uncertainty due to wiper noise and the user's hand at the stop.
    constexpr double tolerance_rad = 0.01;
    const bool agrees = largest_change_rad <= tolerance_rad;
    findings_->sentences.push_back(
        fmt::format("Gimbal {}, {}: wiper from {:.4f} to {:.4f} of its supply; angle = {:.4f} r^2 + {:.4f} r + {:.4f} "
                    "rad, at most {:.3f} rad from the device's curve{}.",
                    axis, axis_name(axis), points.least_ratio, points.most_ratio, curve.square_rad, curve.slope_rad,
                    curve.offset_rad, largest_change_rad, agrees ? ", so the device keeps its curve" : ""));
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
    findings_->propose(set, of_number(Parameter::gimbal_1_square_rad, axis), curve.square_rad, reason);
    findings_->propose(set, of_number(Parameter::gimbal_1_slope_rad, axis), curve.slope_rad, reason);
    findings_->propose(set, of_number(Parameter::gimbal_1_offset_rad, axis), curve.offset_rad, reason);
  }

  std::shared_ptr<Findings> findings_;
  std::vector<std::shared_ptr<AxisPoints>> axes_;
  bool quadratic_;
};

Plan plan_potentiometers(const Choices& choices) {
  const PotentiometerOptions& options = choices.potentiometers;
  Plan plan;
  std::vector<std::shared_ptr<AxisPoints>> axes;
  for (int axis = 1; axis <= 3; ++axis) {
    auto points = std::make_shared<AxisPoints>();
    points->range = options.range[static_cast<std::size_t>(axis - 1)].value_or(described_range(axis));
    plan.steps.push_back(std::make_unique<TurnGimbal>(points, axis, false));
    if (options.quadratic) plan.steps.push_back(std::make_unique<TurnGimbal>(points, axis, true));
    axes.push_back(std::move(points));
  }
  plan.steps.push_back(std::make_unique<FitPotentiometers>(plan.findings, axes, options.quadratic));
  return plan;
}

}  // namespace

const Offer potentiometer_guide{"calibrate", "pots", "Potentiometers",
                                "You turn each axis of the gimbal to both its stops.", plan_potentiometers};

}  // namespace inkwell::guides
