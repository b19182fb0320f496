// A ros2_control hardware component: three joints with position, velocity and effort, and effort commands.
//
// Joint 3 of the library is measured from the base, but the elbow of a URDF is relative to link 2. In a URDF with the
// axes of REP-103, joint 1 turns about -z. At all joints 0, link 2 points to the user, and link 3 straight down.
//
//   Parameters in the <hardware> element:
//     address          address of the arm for inkwell_open(); by default the only arm on USB
//     thread_priority  SCHED_FIFO priority of the library's threads; by default normal threads
//
// Written for ROS 2 Humble. Later distributions warn that export_state_interfaces() is deprecated.
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <hardware_interface/system_interface.hpp>
#include <hardware_interface/types/hardware_interface_type_values.hpp>
#include <pluginlib/class_list_macros.hpp>
#include <rclcpp/rclcpp.hpp>

#include <inkwell/inkwell.hpp>

namespace inkwell_ros {

using hardware_interface::CallbackReturn, hardware_interface::return_type;

class InkwellSystem : public hardware_interface::SystemInterface {
 public:
  CallbackReturn on_init(const hardware_interface::HardwareInfo& info) override {
    if (hardware_interface::SystemInterface::on_init(info) != CallbackReturn::SUCCESS) return CallbackReturn::ERROR;
    if (info_.joints.size() == joints) return CallbackReturn::SUCCESS;
    RCLCPP_ERROR(logger_, "The URDF has %zu joints for this arm. Describe %zu joints.", info_.joints.size(), joints);
    return CallbackReturn::ERROR;
  }

  std::vector<hardware_interface::StateInterface> export_state_interfaces() override {
    std::vector<hardware_interface::StateInterface> all;
    for (std::size_t i = 0; i < joints; ++i) {
      all.emplace_back(info_.joints[i].name, hardware_interface::HW_IF_POSITION, &position_rad_[i]);
      all.emplace_back(info_.joints[i].name, hardware_interface::HW_IF_VELOCITY, &speed_rad_per_s_[i]);
      all.emplace_back(info_.joints[i].name, hardware_interface::HW_IF_EFFORT, &effort_Nm_[i]);
    }
    all.emplace_back("stylus", "received_s", &received_s_);  // for the stamps of messages
    return all;
  }

  std::vector<hardware_interface::CommandInterface> export_command_interfaces() override {
    std::vector<hardware_interface::CommandInterface> all;
    for (std::size_t i = 0; i < joints; ++i)
      all.emplace_back(info_.joints[i].name, hardware_interface::HW_IF_EFFORT, &command_Nm_[i]);
    return all;
  }

  CallbackReturn on_configure(const rclcpp_lifecycle::State&) override {
    return attempt([this] {
      arm_ = std::make_unique<inkwell::Arm>(parameter("address"), open_timeout_s);
      if (const std::string priority = parameter("thread_priority"); !priority.empty())
        arm_->set_thread_priority(std::stoi(priority));
    });
  }

  CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) override {
    return attempt([this] { arm_.reset(); });
  }

  CallbackReturn on_activate(const rclcpp_lifecycle::State&) override {
    command_Nm_ = {};
    return attempt([this] {
      arm_->claim();  // write() must not wait for the claim
      arm_->enable_force();
    });
  }

  CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) override {
    return attempt([this] { arm_->release(); });
  }

  return_type read(const rclcpp::Time&, const rclcpp::Duration&) override {
    inkwell_arm_state state;
    if (inkwell_get_state(arm_->get(), &state, sizeof state) != INKWELL_OK) return report();
    if (state.is_referenced == 0) return return_type::OK;  // the last valid joint angles remain
    for (std::size_t i = 0; i < joints; ++i) {
      position_rad_[i] = state.pose.joint_rad[i];
      speed_rad_per_s_[i] = state.joint_speed_rad_per_s[i];
      effort_Nm_[i] = state.joint_torque_Nm[i];
    }
    position_rad_[2] -= position_rad_[1];
    speed_rad_per_s_[2] -= speed_rad_per_s_[1];
    effort_Nm_[1] += effort_Nm_[2];
    received_s_ = 1e-9 * static_cast<double>(state.received_ns);
    return return_type::OK;
  }

  return_type write(const rclcpp::Time&, const rclcpp::Duration&) override {
    std::array<double, joints> torque_Nm = command_Nm_;
    for (double& torque : torque_Nm)
      if (!std::isfinite(torque)) torque = 0.0;  // a controller has not written the command yet
    torque_Nm[1] -= torque_Nm[2];                // the elbow motor acts on the base, not on link 2
    const inkwell_result result = inkwell_set_joint_torques(arm_->get(), torque_Nm.data());
    return result == INKWELL_OK || result == INKWELL_REFUSED ? return_type::OK : report();
  }

 private:
  static constexpr std::size_t joints = 3;
  static constexpr double open_timeout_s = 10.0;

  std::string parameter(const std::string& name) const {
    const auto found = info_.hardware_parameters.find(name);
    return found == info_.hardware_parameters.end() ? std::string() : found->second;
  }

  return_type report() const {
    RCLCPP_ERROR(logger_, "%s", inkwell_error_text());
    return return_type::ERROR;
  }

  template <class Action>
  CallbackReturn attempt(Action action) const {
    try {
      action();
      return CallbackReturn::SUCCESS;
    } catch (const std::exception& error) {
      RCLCPP_ERROR(logger_, "%s", error.what());
      return CallbackReturn::FAILURE;
    }
  }

  const rclcpp::Logger logger_ = rclcpp::get_logger("InkwellSystem");
  std::unique_ptr<inkwell::Arm> arm_;
  std::array<double, joints> position_rad_{}, speed_rad_per_s_{}, effort_Nm_{}, command_Nm_{};
  double received_s_ = 0;
};

}  // namespace inkwell_ros

PLUGINLIB_EXPORT_CLASS(inkwell_ros::InkwellSystem, hardware_interface::SystemInterface)
