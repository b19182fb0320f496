#include "host/client/guides/joint_motion.hpp"

#include <cmath>

#include <fmt/format.h>

#include "firmware/control/settings.hpp"
#include "firmware/control/signal_path/kinematics.hpp"

namespace inkwell::guides {
namespace {

using protocol::Parameter;
using protocol::State;

constexpr double least_turn_rad = 0.15;  // larger than accidental motion, and far from any stop
constexpr double resting_s = 0.2;

double joint_rad(const device::Pose& pose, int joint) { return static_cast<double>(pose.joint_rad[joint - 1]); }

}  // namespace

const char* joint_name(int joint) {
  constexpr const char* names[] = {"the waist", "the shoulder", "the elbow"};
  return names[joint - 1];
}

std::string forward_direction(const protocol::ParameterSet& parameters, int joint) {
  const control::Arm arm = control::prepare(parameters).arm;
  const control::Triple angles = parameters.of_each(Parameter::inkwell_joint_1_rad);
  control::Triple turned = angles;
  turned[static_cast<std::size_t>(joint - 1)] += 0.1f;
  // The elbow position shows the motion of the shoulder best. The probe position shows the motion of waist and elbow
  // best.
  const auto seen = [&](const control::Triple& at) {
    const auto ends = control::link_ends(at, arm);
    return joint == 2 ? ends.elbow_m : ends.probe_m;
  };
  const control::Vector3 before = seen(angles), after = seen(turned);
  const double moved[] = {static_cast<double>(after.x - before.x), static_cast<double>(after.y - before.y),
                          static_cast<double>(after.z - before.z)};
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(moved[i]) > std::abs(moved[axis])) axis = i;
  // Axes of control::Frame. In the paper's frame the user faces the arm and looks in the -x direction.
  constexpr const char* words[2][3][2] = {{{"away from you, to the arm's base", "towards you, off the arm's base"},
                                           {"to the left", "to the right"},
                                           {"down", "up"}},
                                          {{"to the left", "to the right"},
                                           {"down", "up"},
                                           {"away from you, to the arm's base", "towards you, off the arm's base"}}};
  return words[arm.frame == control::Frame::omni ? 1 : 0][axis][moved[axis] > 0 ? 1 : 0];
}

// ---- inkwell ---------------------------------------------------------------------------------------------

bool RestInInkwell::advance(const Observation& now, DevicePort&) {
  const auto& pose = *now.pose;
  const bool closed = is_closed(pose.switches, protocol::Switch::inkwell);
  const bool referenced = pose.state == State::ready;
  checks_ = {{"inkwell switch", closed ? 1.0 : 0.0, "", "closed", closed},
             {"state " + std::string(info(pose.state).name), referenced ? 1.0 : 0.0, "", "ready", referenced}};
  for (int joint = 1; joint <= 3; ++joint) {
    const double expected_rad =
        static_cast<double>((*now.parameters)[of_number(Parameter::inkwell_joint_1_rad, joint)]);
    const double measured_rad = joint_rad(pose, joint);
    checks_.push_back({fmt::format("joint {}", joint), measured_rad, "rad", fmt::format("{:.3f}", expected_rad),
                       std::abs(measured_rad - expected_rad) < 0.005});
  }
  if (since_.seconds(pose) > user_limit_s)
    throw device::Error(
        "The stylus did not come to rest in the inkwell. If it is in, check the inkwell's switch and its "
        "wiring, and start the guide again.");
  if (!closed || !referenced) {
    resting_.reset();
    return false;
  }
  if (!resting_) resting_.emplace().start(pose);
  if (resting_->seconds(pose) < resting_s) return false;
  if (reports_) {
    findings_->sentences.push_back(fmt::format(
        "The inkwell's switch is closed and the arm is referenced there: joints at {:.4f}, {:.4f} and {:.4f} rad, "
        "probe at {:.1f}, {:.1f}, {:.1f} mm.",
        joint_rad(pose, 1), joint_rad(pose, 2), joint_rad(pose, 3), 1e3 * static_cast<double>(pose.position_m[0]),
        1e3 * static_cast<double>(pose.position_m[1]), 1e3 * static_cast<double>(pose.position_m[2])));
    findings_->details["inkwell"] = {{"joint_rad", {joint_rad(pose, 1), joint_rad(pose, 2), joint_rad(pose, 3)}},
                                     {"position_m", {pose.position_m[0], pose.position_m[1], pose.position_m[2]}}};
  }
  return true;
}

// ---- joint turned by the user -----------------------------------------------------------------------------

std::string TurnJointForward::title() const { return fmt::format("Encoder {}, {}", joint_, joint_name(joint_)); }

std::string TurnJointForward::text() const {
  const std::string what = joint_ == 2 ? "the elbow" : "the stylus";
  if (direction_.empty())
    return fmt::format(
        "Take the stylus out of the inkwell and turn joint {}, {}, as described in the next text. No current flows.",
        joint_, joint_name(joint_));
  return fmt::format("Turn joint {}, {}, so that {} moves {} by about 3 cm. No current flows.", joint_,
                     joint_name(joint_), what, direction_);
}

void TurnJointForward::begin(const Observation& now, DevicePort&) {
  direction_ = forward_direction(*now.parameters, joint_);
  for (int joint = 1; joint <= 3; ++joint)
    began_rad_[static_cast<std::size_t>(joint - 1)] = joint_rad(*now.pose, joint);
  since_.start(*now.pose);
}

bool TurnJointForward::advance(const Observation& now, DevicePort&) {
  turned_rad_ = joint_rad(*now.pose, joint_) - began_rad_[static_cast<std::size_t>(joint_ - 1)];
  if (since_.seconds(*now.pose) > user_limit_s)
    throw device::Error(
        fmt::format("Joint {} did not turn by {} rad. If you turned it, check the plug and the supply of "
                    "encoder {}.",
                    joint_, least_turn_rad, joint_));
  if (std::abs(turned_rad_) < least_turn_rad) return false;
  const auto parameter = of_number(Parameter::encoder_1_reversed, joint_);
  const bool wrong = turned_rad_ < 0;
  (*reversed_)[static_cast<std::size_t>(joint_ - 1)] = wrong;
  findings_->sentences.push_back(fmt::format("Encoder {} counts {} when joint {} turns forward.", joint_,
                                             wrong ? "down, which is wrong," : "up, as expected,", joint_));
  findings_->details["encoders"].push_back({{"encoder", joint_}, {"turned_rad", turned_rad_}, {"counts_up", !wrong}});
  if (wrong)
    findings_->propose(*now.parameters, parameter, (*now.parameters)[parameter] == 0.0f ? 1.0 : 0.0,
                       fmt::format("joint {} turned forward and the encoder counted down", joint_));
  return true;
}

std::vector<Check> TurnJointForward::checks() const {
  return {{fmt::format("joint {} turned by", joint_), turned_rad_, "rad", fmt::format("{} or more", least_turn_rad),
           turned_rad_ >= least_turn_rad}};
}

}  // namespace inkwell::guides
