// A pose with what follows from it.
#pragma once

#include <chrono>
#include <optional>

#include <inkwell/inkwell.h>
#include <control/kinematics.hpp>
#include <device/device.hpp>
#include <kinematics/velocity.hpp>

namespace inkwell::library {

struct ReadPose {
  inkwell_pose pose;
  bool is_referenced;
};

/// Of one arm, for one thread.
class PoseReader {
 public:
  inkwell_pose read(const device::Pose& report, const control::Arm& geometry);
  /// The newest pose that the device has sent; waits for one if there is none, and returns none on time-out. A reader
  /// that was late does not pass on the older ones, which a servo would answer too late.
  std::optional<ReadPose> read_newest(device::Device& device, std::chrono::milliseconds timeout,
                                      const control::Arm& geometry);

 private:
  kinematics::VelocityFit velocity_;
};

}  // namespace inkwell::library
