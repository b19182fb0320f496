#include "host/client/guides/simulated_user.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/kinematics.hpp"

namespace inkwell::guides {
namespace {

using protocol::Parameter;
using Rows = protocol::EachAxis<Parameter>;

constexpr double firm_N_per_m = 600, loose_N_per_m = 120, damping_Ns_per_m = 6;
constexpr double joint_speed_rad_s = 2.0;
constexpr double chord_rad = 0.15;   // largest distance of path points, because the hand moves in straight lines
                                     // between them
constexpr double turn_rad = 0.25;    // angle of a joint turn
constexpr double beyond_rad = 0.02;  // distance of the hand's target beyond a stop
constexpr double hold_s = 0.6;       // duration at a stop
constexpr double press_s = 0.1;

}  // namespace

SimulatedUser::SimulatedUser(device::ControlClient control, const protocol::ParameterSet& arm)
    : control_(std::move(control)), arm_(arm) {
  for (int axis = 1; axis <= 3; ++axis) {
    const auto of = [&](Rows rows) { return static_cast<double>(arm_[of_number(rows, axis)]); };
    // Initially the wipers are in the middle of their tracks.
    gimbal_rad_[static_cast<std::size_t>(axis - 1)] = of(Parameter::gimbal_1_square_rad) / 4 +
                                                      of(Parameter::gimbal_1_slope_rad) / 2 +
                                                      of(Parameter::gimbal_1_offset_rad);
  }
  joints_ = inkwell();
}

device::Vector3 SimulatedUser::probe_m(const Joints& joints) const {
  const control::Triple angles{static_cast<float>(joints[0]), static_cast<float>(joints[1]),
                               static_cast<float>(joints[2])};
  const auto probe = control::forward_kinematics(angles, control::prepare(arm_).arm).position_m;
  return {static_cast<double>(probe.x), static_cast<double>(probe.y), static_cast<double>(probe.z)};
}

double SimulatedUser::limit_rad(int joint, bool upper) const {
  return static_cast<double>(arm_[of_number(upper ? protocol::upper_stops : protocol::lower_stops, joint)]);
}

SimulatedUser::Joints SimulatedUser::inkwell() const {
  const auto joints_rad = arm_.of_each(Parameter::inkwell_joint_1_rad);
  Joints joints{};
  std::copy(joints_rad.begin(), joints_rad.end(), joints.begin());
  return joints;
}

/// Removes the stylus from the inkwell. The stylus then moves through the poses, from the end of its last motion.
/// Returns the duration.
double SimulatedUser::move(std::vector<Joints> through, double stiffness_N_per_m) {
  through.insert(through.begin(), joints_);
  joints_ = through.back();
  std::vector<device::HandWaypoint> path;
  double time_s = 0;
  for (std::size_t i = 0; i + 1 < through.size(); ++i) {
    double widest_rad = 0;
    for (std::size_t j = 0; j < 3; ++j) widest_rad = std::max(widest_rad, std::abs(through[i + 1][j] - through[i][j]));
    const int pieces = std::max(1, static_cast<int>(std::ceil(widest_rad / chord_rad)));
    const double piece_s = std::max(0.02, widest_rad / joint_speed_rad_s / pieces);
    for (int piece = 1; piece <= pieces; ++piece) {
      Joints joints{};
      for (std::size_t j = 0; j < 3; ++j)
        joints[j] = through[i][j] + (through[i + 1][j] - through[i][j]) * piece / pieces;
      time_s += piece_s;
      path.push_back({time_s, probe_m(joints)});
    }
    if (i + 2 < through.size()) path.push_back({time_s += hold_s, probe_m(through[i + 1])});
  }
  const auto here = control_.truth();
  control_.hand({true,
                 {here.at("true_position_x_m"), here.at("true_position_y_m"), here.at("true_position_z_m")},
                 stiffness_N_per_m,
                 damping_Ns_per_m});
  control_.dock(false);
  control_.hand_path(path);
  return time_s;
}

/// Moves slightly beyond both stops. Only the spring of the hand presses, so the force is small.
void SimulatedUser::move_to_stops(int joint, double now_s) {
  const auto middle = [&](int each) { return (limit_rad(each, false) + limit_rad(each, true)) / 2; };
  const bool parallelogram = arm_[Parameter::transmission] == 1.0f;
  // Waist angle, shoulder angle, and elbow angle relative to the elbow stops.
  const auto joints_at = [&](double waist_rad, double shoulder_rad, double elbow_rad) {
    return Joints{waist_rad, shoulder_rad, elbow_rad + (parallelogram ? shoulder_rad : 0)};
  };
  const auto with = [&](double angle_rad) {
    return joints_at(joint == 1 ? angle_rad : 0, joint == 2 ? angle_rad : middle(2),
                     joint == 3 ? angle_rad : middle(3));
  };
  const double lasts_s =
      move({with(middle(joint)), with(limit_rad(joint, false) - beyond_rad), with(limit_rad(joint, true) + beyond_rad)},
           firm_N_per_m);
  press_button(1, now_s + lasts_s + hold_s);
}

void SimulatedUser::press_button(int button, double at_s) {
  planned_.push_back(
      {at_s, [this, button] {
         control_.buttons(button == 1, button == 2);
         // The release is timed from the actual press, because a busy computer may press late.
         planned_.push_back({control_.status().board_time_s + press_s, [this] { control_.buttons(false, false); }});
       }});
}

void SimulatedUser::begin(const UserTask& task, double now_s) {
  using Kind = UserTask::Kind;
  const auto index = static_cast<std::size_t>(std::max(task.number, 1) - 1);
  const auto turn_gimbal = [&](double ratio, double at_s) {
    const auto of = [&](Rows rows) { return static_cast<double>(arm_[of_number(rows, task.number)]); };
    const double angle_rad = (of(Parameter::gimbal_1_square_rad) * ratio + of(Parameter::gimbal_1_slope_rad)) * ratio +
                             of(Parameter::gimbal_1_offset_rad);
    planned_.push_back({at_s, [this, index, angle_rad] {
                          gimbal_rad_[index] = angle_rad;
                          control_.gimbal(gimbal_rad_);
                        }});
  };
  switch (task.kind) {
    case Kind::none: break;
    case Kind::rest_in_inkwell:
      control_.dock(true);
      joints_ = inkwell();
      break;
    case Kind::hold_loosely: {
      Joints lifted = inkwell();
      lifted[1] += 0.15;
      lifted[2] += 0.15;
      move({lifted}, loose_N_per_m);
      break;
    }
    case Kind::turn_joint_forward: {
      Joints turned = inkwell();
      turned[index] += turn_rad;
      move({turned}, firm_N_per_m);
      break;
    }
    case Kind::move_joint_to_stops: move_to_stops(task.number, now_s); break;
    case Kind::turn_gimbal_to_stops:
      turn_gimbal(0, now_s);
      turn_gimbal(1, now_s + 0.3);
      press_button(1, now_s + 0.6);
      break;
    case Kind::centre_gimbal:
      turn_gimbal(0.5, now_s);
      press_button(1, now_s + 0.3);
      break;
    case Kind::press_button: press_button(task.number, now_s + 0.1); break;
  }
}

void SimulatedUser::advance(const UserTask& task) {
  if (task == task_ && planned_.empty()) return;
  const double now_s = control_.status().board_time_s;
  if (task != task_) {
    // Remaining actions of the previous step are discarded. A button of the previous step is released.
    if (!planned_.empty()) control_.buttons(false, false);
    planned_.clear();
    task_ = task;
    begin(task, now_s);
  }
  while (!planned_.empty() && planned_.front().at_s <= now_s) {
    planned_.front().act();
    planned_.pop_front();
  }
}

}  // namespace inkwell::guides
