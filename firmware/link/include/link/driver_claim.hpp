// The program that drives the arm, of those that are connected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <protocol/driver.hpp>

namespace inkwell::link {

/// Holds the claim of one program at a time. Main loop only.
class DriverClaim {
 public:
  /// Carries out a ClaimReport. Returns true if it ended the claim that was held, by release or takeover. A report that
  /// is too short, of another version, with an unknown operation or with claim 0 has no effect.
  bool accept(std::span<const std::byte> report, std::uint32_t now_periods);

  /// Whether a request with this claim may be carried out: there is no driver, or this is the driver.
  bool permits(std::uint32_t claim) const { return claim_ == 0 || claim == claim_; }
  void count_refusal() { ++refused_; }
  bool is_held() const { return claim_ != 0; }
  /// Whether this is the driver.
  bool is_held_by(std::uint32_t claim) const { return claim != 0 && claim == claim_; }

  /// Counts the seconds that the program drives. Call it more often than once a second.
  void pass_time(std::uint32_t now_periods);
  /// The driver was heard.
  void renew(std::uint32_t now_periods) { heard_at_periods_ = now_periods; }
  /// Whether the driver has been silent for too long. Call it more often than the counter of periods wraps.
  bool has_expired(std::uint32_t now_periods) const;
  /// No program drives the arm from now on.
  void end();

  protocol::DriverReport report(std::uint32_t now_periods) const;
  std::uint32_t changes() const { return changes_; }

 private:
  void begin(const protocol::ClaimReport& claim, std::uint32_t now_periods);

  std::uint32_t claim_ = 0;  ///< 0: no program drives the arm
  protocol::DriverReport driver_{};
  std::uint32_t heard_at_periods_ = 0;
  std::uint32_t second_began_periods_ = 0;  ///< of the driver, because the count of periods wraps after 59 hours
  std::uint32_t changes_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace inkwell::link
