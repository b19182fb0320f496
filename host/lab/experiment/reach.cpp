#include "host/lab/experiment/reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/kinematics.hpp"

namespace inkwell::experiment {
namespace {

using protocol::Parameter;
using protocol::ParameterSet;
using Joints = std::array<double, 3>;

struct Range {
  double minimum, maximum;
  double at(double part) const { return minimum + part * (maximum - minimum); }
};

class Reach {
 public:
  explicit Reach(const ParameterSet& parameters)
      : arm_(control::prepare(parameters).arm),
        joint_1_{range_of(parameters, Parameter::joint_1_minimum_rad, Parameter::joint_1_maximum_rad)},
        joint_2_{range_of(parameters, Parameter::joint_2_minimum_rad, Parameter::joint_2_maximum_rad)},
        elbow_{range_of(parameters, Parameter::elbow_minimum_rad, Parameter::elbow_maximum_rad)} {}

  /// Projected gradient steps from a start at these parts of the joint ranges.
  double distance_m(const device::Vector3& target_m, double part_1, double part_2, double part_elbow) const {
    Joints joints = within_stops({joint_1_.at(part_1), joint_2_.at(part_2),
                                  elbow_.at(part_elbow) + (is_parallelogram() ? joint_2_.at(part_2) : 0.0)});
    constexpr int rounds = 200;
    constexpr double close_m = 1e-4, damping_m2 = 1e-5;
    double distance_m = 0;
    for (int round = 0; round < rounds; ++round) {
      const auto pose = pose_at(joints);
      const std::array<double, 3> miss_m{target_m[0] - static_cast<double>(pose.position_m.x),
                                         target_m[1] - static_cast<double>(pose.position_m.y),
                                         target_m[2] - static_cast<double>(pose.position_m.z)};
      distance_m = std::hypot(miss_m[0], miss_m[1], miss_m[2]);
      if (distance_m < close_m) break;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& column = pose.jacobian.column[i];
        const std::array<double, 3> slope{static_cast<double>(column.x), static_cast<double>(column.y),
                                          static_cast<double>(column.z)};
        const double along = slope[0] * miss_m[0] + slope[1] * miss_m[1] + slope[2] * miss_m[2];
        const double size = slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
        constexpr double step = 0.5;  // the steps of several joints add up
        joints[i] += step * along / (size + damping_m2);
      }
      joints = within_stops(joints);
    }
    return distance_m;
  }

 private:
  static Range range_of(const ParameterSet& parameters, Parameter minimum, Parameter maximum) {
    return {static_cast<double>(parameters[minimum]), static_cast<double>(parameters[maximum])};
  }
  bool is_parallelogram() const { return arm_.transmission == control::Transmission::parallelogram; }
  Joints within_stops(Joints joints) const {
    joints[0] = std::clamp(joints[0], joint_1_.minimum, joint_1_.maximum);
    joints[1] = std::clamp(joints[1], joint_2_.minimum, joint_2_.maximum);
    const double base = is_parallelogram() ? joints[1] : 0.0;
    joints[2] = base + std::clamp(joints[2] - base, elbow_.minimum, elbow_.maximum);
    return joints;
  }
  control::Pose pose_at(const Joints& joints) const {
    return control::forward_kinematics(
        {static_cast<float>(joints[0]), static_cast<float>(joints[1]), static_cast<float>(joints[2])}, arm_);
  }

  control::Arm arm_;
  Range joint_1_, joint_2_, elbow_;
};

}  // namespace

double distance_to_reach_m(const ParameterSet& parameters, const device::Vector3& target_m) {
  const Reach reach(parameters);
  double nearest_m = std::numeric_limits<double>::infinity();
  // Several starts, because the steps from one start may end at a stop.
  for (const double part_1 : {0.25, 0.5, 0.75})
    for (const double part_2 : {0.2, 0.5, 0.8})
      for (const double part_elbow : {0.2, 0.5, 0.8})
        nearest_m = std::min(nearest_m, reach.distance_m(target_m, part_1, part_2, part_elbow));
  return nearest_m;
}

}  // namespace inkwell::experiment
