// A CHAI3D 3 haptic device. Pass the device to a tool, because the device handler of CHAI3D does not list it:
//
//   tool->setHapticDevice(chai3d::cInkwellDevice::create());
//
// In CHAI3D x points to the user, y to the right and z up. The force is off until the stylus has rested in the inkwell.
// After a fault or a stop by another program, setForce() fails until the program opens the device again.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <chai3d.h>

#include <inkwell/inkwell.hpp>

namespace chai3d {

class cInkwellDevice;
using cInkwellDevicePtr = std::shared_ptr<cInkwellDevice>;

class cInkwellDevice : public cGenericHapticDevice {
 public:
  /// Accepts the addresses of inkwell_open().
  explicit cInkwellDevice(std::string address = "") : address_(std::move(address)) {
    m_deviceAvailable = true;
    m_deviceReady = false;
    m_specifications.m_model = C_HAPTIC_DEVICE_CUSTOM;
    m_specifications.m_manufacturerName = "Inkwell";
    m_specifications.m_modelName = "Inkwell haptic arm";
    m_specifications.m_maxAngularTorque = m_specifications.m_maxGripperForce = 0.0;
    m_specifications.m_sensedPosition = m_specifications.m_sensedRotation = true;
    m_specifications.m_actuatedPosition = true;
    m_specifications.m_sensedGripper = m_specifications.m_actuatedGripper = false;
    m_specifications.m_actuatedRotation = false;
    m_specifications.m_leftHand = m_specifications.m_rightHand = true;
  }
  ~cInkwellDevice() override { cInkwellDevice::close(); }
  static cInkwellDevicePtr create(const std::string& address = "") { return std::make_shared<cInkwellDevice>(address); }

  bool open() override {
    if (m_deviceReady) return C_ERROR;
    try {
      auto arm = std::make_unique<inkwell::Arm>(address_, open_timeout_s);
      arm->claim();
      const inkwell::Abilities abilities = arm->abilities();
      m_specifications.m_maxLinearForce = abilities.continuous_force_N;
      m_specifications.m_maxLinearStiffness = abilities.stiffness_N_per_m;
      m_specifications.m_maxLinearDamping = abilities.damping_Ns_per_m;
      m_specifications.m_workspaceRadius = abilities.workspace_radius_m;
      arm_ = std::move(arm);
    } catch (const inkwell::Failure&) {  // inkwell_error_text() has the cause
      return C_ERROR;
    }
    has_enabled_ = false;
    m_deviceReady = true;
    return C_SUCCESS;
  }

  bool close() override {
    if (!m_deviceReady) return C_ERROR;
    m_deviceReady = false;
    arm_.reset();  // fades the force
    return C_SUCCESS;
  }

  bool calibrate(bool = false) override { return m_deviceReady; }

  bool getPosition(cVector3d& position_m) override {
    if (!read()) return C_ERROR;
    position_m = to_chai3d(state_.pose.position_m);
    return C_SUCCESS;
  }
  bool getLinearVelocity(cVector3d& velocity_m_per_s) override {
    if (!read()) return C_ERROR;
    velocity_m_per_s = m_linearVelocity = to_chai3d(state_.pose.velocity_m_s);
    return C_SUCCESS;
  }
  bool getAngularVelocity(cVector3d& velocity_rad_per_s) override {
    if (!read()) return C_ERROR;
    velocity_rad_per_s = m_angularVelocity = to_chai3d(state_.angular_velocity_rad_per_s);
    return C_SUCCESS;
  }
  bool getRotation(cMatrix3d& rotation) override {
    if (!read()) return C_ERROR;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        rotation(row, column) = state_.pose.rotation[3 * axis_of[row] + axis_of[column]];
    return C_SUCCESS;
  }
  bool getUserSwitches(unsigned int& switches) override {
    if (!read()) return C_ERROR;
    switches = (state_.pose.button_1 != 0 ? 1u : 0u) | (state_.pose.button_2 != 0 ? 2u : 0u);
    return C_SUCCESS;
  }

  /// The gimbal and the stylus have no motors, so torque and gripper force have no effect.
  bool setForceAndTorqueAndGripperForce(const cVector3d& force_N, const cVector3d&, double) override {
    if (!read()) return C_ERROR;
    if (state_.pose.state == INKWELL_READY && !has_enabled_) {
      has_enabled_ = true;
      if (inkwell_enable_force(arm_->get(), enable_timeout_s) != INKWELL_OK) return C_ERROR;
    }
    if (!has_enabled_) return C_SUCCESS;  // the stylus was not in the inkwell yet
    const double workspace_N[3]{force_N.y(), force_N.z(), force_N.x()};
    if (inkwell_set_force(arm_->get(), workspace_N) != INKWELL_OK) return C_ERROR;
    m_prevForce = force_N;
    return C_SUCCESS;
  }

 private:
  static constexpr double open_timeout_s = 10.0, enable_timeout_s = 1.0;
  static constexpr int axis_of[3]{2, 0, 1};  ///< workspace axis of each CHAI3D axis

  /// False while no poses arrive.
  bool read() { return m_deviceReady && inkwell_get_state(arm_->get(), &state_, sizeof state_) == INKWELL_OK; }
  static cVector3d to_chai3d(const double (&vector)[3]) {
    return cVector3d(vector[axis_of[0]], vector[axis_of[1]], vector[axis_of[2]]);
  }

  const std::string address_;
  std::unique_ptr<inkwell::Arm> arm_;
  inkwell_arm_state state_{};
  bool has_enabled_ = false;
};

}  // namespace chai3d
