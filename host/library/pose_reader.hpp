// A pose with what follows from it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include <inkwell/inkwell.h>
#include <control/kinematics.hpp>
#include <device/device.hpp>
#include <kinematics/velocity.hpp>
#include <protocol/reports.hpp>

namespace inkwell::library {

struct ReadPose {
  inkwell_pose pose;
  bool is_referenced;
};

/// Of one arm, for one thread.
class PoseReader {
 public:
  inkwell_pose read(const protocol::PoseReport& report, const control::Arm& geometry);
  /// The newest pose that the device has sent; waits for one if there is none, and returns none on time-out. A reader
  /// that was late does not pass on the older ones, which a servo would answer too late.
  std::optional<ReadPose> read_newest(device::Device& device, std::chrono::milliseconds timeout,
                                      const control::Arm& geometry);

 private:
  kinematics::VelocityFit velocity_;
  std::uint64_t periods_ = 0;  ///< since the board started, beyond the wrap of the report's counter
};

}  // namespace inkwell::library
