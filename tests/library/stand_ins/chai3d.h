// Stand-in for the header of CHAI3D 3. It declares only what the example uses, and is not a copy.
#pragma once

#include <string>

namespace chai3d {

constexpr bool C_SUCCESS = true, C_ERROR = false;

class cVector3d {
 public:
  cVector3d() = default;
  cVector3d(double x, double y, double z) : values_{x, y, z} {}
  double x() const { return values_[0]; }
  double y() const { return values_[1]; }
  double z() const { return values_[2]; }

 private:
  double values_[3]{};
};

class cMatrix3d {
 public:
  double& operator()(int row, int column) { return values_[3 * row + column]; }

 private:
  double values_[9]{};
};

enum cHapticDeviceModel { C_HAPTIC_DEVICE_CUSTOM };

struct cHapticDeviceInfo {
  cHapticDeviceModel m_model;
  std::string m_modelName, m_manufacturerName;
  double m_maxLinearForce, m_maxAngularTorque, m_maxGripperForce;
  double m_maxLinearStiffness, m_maxLinearDamping, m_workspaceRadius;
  bool m_sensedPosition, m_sensedRotation, m_sensedGripper;
  bool m_actuatedPosition, m_actuatedRotation, m_actuatedGripper;
  bool m_leftHand, m_rightHand;
};

class cGenericHapticDevice {
 public:
  virtual ~cGenericHapticDevice() = default;
  virtual bool open() { return C_ERROR; }
  virtual bool close() { return C_ERROR; }
  virtual bool calibrate(bool = false) { return C_ERROR; }
  virtual bool getPosition(cVector3d&) { return C_ERROR; }
  virtual bool getLinearVelocity(cVector3d&) { return C_ERROR; }
  virtual bool getAngularVelocity(cVector3d&) { return C_ERROR; }
  virtual bool getRotation(cMatrix3d&) { return C_ERROR; }
  virtual bool getUserSwitches(unsigned int&) { return C_ERROR; }
  virtual bool setForceAndTorqueAndGripperForce(const cVector3d&, const cVector3d&, double) { return C_ERROR; }
  bool setForce(const cVector3d& force_N) { return setForceAndTorqueAndGripperForce(force_N, cVector3d(), 0.0); }
  cHapticDeviceInfo getSpecifications() { return m_specifications; }

 protected:
  cHapticDeviceInfo m_specifications{};
  bool m_deviceReady = false, m_deviceAvailable = false;
  cVector3d m_prevForce, m_linearVelocity, m_angularVelocity;
};

}  // namespace chai3d
