// Reports of the device with widened counters. Device returns these reports instead of the protocol structures.
#pragma once

#include <cstdint>

#include "protocol/reports.hpp"

namespace inkwell::device {

/// A PoseReport with widened counters. protocol::PoseReport describes the members.
struct Pose {
  protocol::State state{};
  protocol::Fault fault{};
  std::uint8_t limits = 0;  ///< bits of protocol::Limit
  bool is_referenced = false;
  std::int64_t sequence = 0;
  std::int64_t time_periods = 0;
  float position_m[3]{};
  float gimbal_rad[3]{};
  float force_N[3]{};
  float joint_rad[3]{};
  std::uint8_t switches = 0;  ///< bits of protocol::Switch
  std::uint8_t driver_parity = 0;
  std::uint8_t force_sources = 0;  ///< bits of protocol::ForceSource
  std::uint8_t servo_load = 0;
  std::uint8_t command_token = 0;
  std::uint8_t supply_dV = 0;
};

Pose widened(const protocol::PoseReport& report, std::int64_t sequence, std::int64_t time_periods);

/// A FrameReport: the start of a bus frame in board time.
struct BusFrame {
  std::int64_t sequence = 0;
  std::int64_t time_periods = 0;
  std::uint32_t time_cycles = 0;
};

/// The TransactionReport of an accepted transaction.
struct AcceptedTransaction {
  std::uint32_t transactions = 0;
  std::int64_t applied_at_periods = 0;
};

constexpr double board_time_s(std::int64_t periods) { return static_cast<double>(periods) / protocol::servo_rate_Hz; }

}  // namespace inkwell::device
