// What a program on the PC asks for: forces, and shapes to be felt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <control/program_force.hpp>
#include <control/shapes.hpp>
#include <link/handover.hpp>
#include <protocol/reports.hpp>
#include <protocol/request_result.hpp>

namespace inkwell::link {

/// The force in a ForceReport (from its report id on), ready for the interrupt; nothing if its length, version, mode,
/// interval or force is not one of the protocol. The report may be padded to the longest output report.
std::optional<control::ForceTarget> decode_force(std::span<const std::byte> report);

/// The same for a ShapesReport; false if anything in its used part is not valid, and then `shapes` is undefined. The
/// bytes after the used part are ignored.
bool decode_shapes(std::span<const std::byte> report, control::Shapes& shapes);

/// The claim in a ForceReport or a ShapesReport; 0 if the report is too short to hold one.
std::uint32_t claim_of_force(std::span<const std::byte> report);
std::uint32_t claim_of_shapes(std::span<const std::byte> report);

/// The ticket in a ShapesReport; 0 if the report is too short to hold one or of another version.
std::uint32_t ticket_of_shapes(std::span<const std::byte> report);

/// Each newer request takes the place of the older one.
class ProgramRequests {
 public:
  // ---- main loop ----

  /// Accepts a ForceReport. False, and counted as refused, if it is not valid, if its program does not drive the arm,
  /// or if it answers a pose that is older than force_pose_age_maximum_ms. `pose_sequence`: of the newest pose report.
  bool accept_force(std::span<const std::byte> report, bool is_of_driver, std::uint32_t pose_sequence);

  /// Accepts a ShapesReport of the driver. `busy` while the interrupt has not taken the previous one, `malformed` if it
  /// is not valid.
  protocol::RequestResult accept_shapes(std::span<const std::byte> report);

  /// The driver is gone, and with it every shape. Its force fades.
  void driver_gone();

  std::uint32_t forces_received() const { return forces_received_; }
  std::uint32_t forces_lost() const { return forces_lost_; }
  std::uint32_t forces_refused() const { return forces_refused_; }

  // ---- control interrupt ----

  /// What came since the last call; null for nothing. Valid until the next call.
  const control::ForceTarget* take_force() { return forces_.take() ? &forces_.used() : nullptr; }
  const control::Shapes* take_shapes() { return shapes_.take() ? &shapes_.used() : nullptr; }

 private:
  Handover<control::ForceTarget> forces_;
  Handover<control::Shapes> shapes_;
  std::uint32_t forces_received_ = 0;
  std::uint32_t forces_lost_ = 0;
  std::uint32_t forces_refused_ = 0;
  std::optional<std::uint32_t> newest_sequence_;  ///< none while no program drives
};

}  // namespace inkwell::link
