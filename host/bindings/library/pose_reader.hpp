// Computes the library pose from a board's pose report.
#pragma once

#include <chrono>
#include <optional>

#include <inkwell/inkwell.h>
#include "firmware/control/signal_path/kinematics.hpp"
#include "host/client/device/device.hpp"
#include "host/client/kinematics/velocity.hpp"

#include "host/bindings/library/motion.hpp"

namespace inkwell::library {

struct ReadPose {
  inkwell_pose pose;
  bool is_referenced;
  Motion motion{};
};

/// Use one object for each arm, in a single thread.
class PoseReader {
 public:
  inkwell_pose read(const device::Pose& report, const control::Arm& geometry);
  /// Returns the motion at the last pose.
  const Motion& motion() const { return motion_; }
  /// Returns the newest pose that the device has sent, and waits if no pose has arrived. Returns none on time-out.
  /// Older poses are skipped, because a servo would answer them too late.
  /// `on_report` receives every pose of the device, also the skipped poses.
  std::optional<ReadPose> read_newest(device::Device& device, std::chrono::milliseconds timeout,
                                      const control::Arm& geometry,
                                      const std::function<void(const device::Pose&)>& on_report = {});

 private:
  kinematics::VelocityFit velocity_;
  MotionFit motion_fit_;
  Motion motion_;
};

}  // namespace inkwell::library
