// Stand-in for the header of ros2_control. It declares only what the example uses, and is not a copy.
#pragma once

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tests/library/stand_ins/rclcpp/rclcpp.hpp"

namespace rclcpp_lifecycle {
class State {};
}  // namespace rclcpp_lifecycle

namespace hardware_interface {

enum class CallbackReturn { SUCCESS, FAILURE, ERROR };
enum class return_type { OK, ERROR };

struct ComponentInfo {
  std::string name;
};
struct HardwareInfo {
  std::unordered_map<std::string, std::string> hardware_parameters;
  std::vector<ComponentInfo> joints;
};

class Handle {
 public:
  Handle(std::string component, std::string interface_name, double* value)
      : name_(std::move(component) + "/" + std::move(interface_name)), value_(value) {}
  const std::string& get_name() const { return name_; }
  double get_value() const { return *value_; }
  void set_value(double value) { *value_ = value; }

 private:
  std::string name_;
  double* value_;
};
using StateInterface = Handle;
using CommandInterface = Handle;

class SystemInterface {
 public:
  virtual ~SystemInterface() = default;
  virtual CallbackReturn on_init(const HardwareInfo& info) {
    info_ = info;
    return CallbackReturn::SUCCESS;
  }
  virtual std::vector<StateInterface> export_state_interfaces() = 0;
  virtual std::vector<CommandInterface> export_command_interfaces() = 0;
  virtual CallbackReturn on_configure(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_activate(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) = 0;
  virtual return_type read(const rclcpp::Time&, const rclcpp::Duration&) = 0;
  virtual return_type write(const rclcpp::Time&, const rclcpp::Duration&) = 0;

 protected:
  HardwareInfo info_;
};

}  // namespace hardware_interface
