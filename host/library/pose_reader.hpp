// A pose with what follows from it.
#pragma once

#include <cstdint>

#include <inkwell/inkwell.h>
#include <control/kinematics.hpp>
#include <kinematics/velocity.hpp>
#include <protocol/reports.hpp>

namespace inkwell::library {

/// Of one arm, for one thread.
class PoseReader {
 public:
  inkwell_pose read(const protocol::PoseReport& report, const control::Arm& geometry);

 private:
  kinematics::VelocityFit velocity_;
  std::uint64_t periods_ = 0;  ///< since the board started, beyond the wrap of the report's counter
};

}  // namespace inkwell::library
