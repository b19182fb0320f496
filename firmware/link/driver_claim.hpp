// The claim identifies the driver among the connected programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/driver.hpp"

namespace inkwell::link {

/// Only the main loop uses this class.
class DriverClaim {
 public:
  /// Executes a ClaimReport. Returns true if the report released or replaced the current claim. An invalid report has
  /// no effect.
  bool accept(std::span<const std::byte> report, std::uint32_t now_periods);

  /// Returns true if requests with this claim are permitted. Without a driver, every claim is permitted.
  bool permits(std::uint32_t claim) const { return claim_ == 0 || claim == claim_; }
  void count_refusal() { ++refused_; }
  bool is_held() const { return claim_ != 0; }
  /// Returns true if the claim belongs to the driver.
  bool is_held_by(std::uint32_t claim) const { return claim != 0 && claim == claim_; }

  /// Counts the seconds since the program became the driver. Call this function at least once per second.
  void pass_time(std::uint32_t now_periods);
  /// Restarts the claim's timeout.
  void renew(std::uint32_t now_periods) { heard_at_periods_ = now_periods; }
  /// True if the claim has expired. Call this function at least once before the period counter wraps.
  bool has_expired(std::uint32_t now_periods) const;
  /// Ends the claim. No program is the driver after this call.
  void end();

  protocol::DriverReport report(std::uint32_t now_periods) const;
  std::uint32_t changes() const { return changes_; }

 private:
  void begin(const protocol::ClaimReport& claim, std::uint32_t now_periods);

  std::uint32_t claim_ = 0;  ///< 0: no program drives the arm
  protocol::DriverReport driver_{};
  std::uint32_t heard_at_periods_ = 0;
  std::uint32_t second_began_periods_ = 0;  ///< start of the current second; the period counter wraps after 59 hours
  std::uint32_t changes_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace inkwell::link
