#include "host/client/device/wide_reports.hpp"

#include <algorithm>

namespace inkwell::device {

Pose widened(const protocol::PoseReport& report, std::int64_t sequence, std::int64_t time_periods) {
  Pose pose{.state = report.state,
            .fault = report.fault,
            .limits = report.limits,
            .is_referenced = report.is_referenced != 0,
            .sequence = sequence,
            .time_periods = time_periods,
            .switches = report.switches,
            .driver_parity = report.driver_parity,
            .force_sources = report.force_sources,
            .servo_load = report.servo_load,
            .command_token = report.command_token,
            .supply_dV = report.supply_dV};
  std::ranges::copy(report.position_m, pose.position_m);
  std::ranges::copy(report.gimbal_rad, pose.gimbal_rad);
  std::ranges::copy(report.force_N, pose.force_N);
  std::ranges::copy(report.joint_rad, pose.joint_rad);
  return pose;
}

}  // namespace inkwell::device
