// Force and shape requests of a program on the PC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/control/signal_path/local_model.hpp"
#include "firmware/control/signal_path/program_force.hpp"
#include "firmware/control/signal_path/shapes.hpp"
#include "firmware/exchange/handover.hpp"
#include "protocol/reports.hpp"
#include "protocol/request_result.hpp"

namespace inkwell::link {

/// Returns the force target of a ForceReport. `report` starts with its report id and may have padding bytes. Returns
/// std::nullopt if length, version, mode, interval or force is invalid.
std::optional<control::ForceTarget> decode_force(std::span<const std::byte> report);

/// Materials of local models.
using Materials = std::array<control::Surface, protocol::materials_maximum>;

/// Decodes a ShapesReport. Without materials in the report, `materials` does not change. Returns false if any part of
/// the report is invalid. If the result is false, `shapes` is undefined and `materials` does not change. Bytes after
/// the used part of the report are ignored.
bool decode_shapes(std::span<const std::byte> report, control::Shapes& shapes, Materials& materials);

/// Decodes the force of a LocalModelReport and its features. `model` may be null. Returns std::nullopt if any part of
/// the report is invalid; then `model` is undefined. `report` starts with its report id and may have padding bytes.
std::optional<control::ForceTarget> decode_local_model(std::span<const std::byte> report, const Materials& materials,
                                                       control::LocalModel* model);

/// Returns the claim of a ForceReport, LocalModelReport or ShapesReport, or 0 if the report is too short.
std::uint32_t claim_of_force(std::span<const std::byte> report);
std::uint32_t claim_of_local_model(std::span<const std::byte> report);
std::uint32_t claim_of_shapes(std::span<const std::byte> report);

/// Returns the ticket of a ShapesReport, or 0 if the report is too short or has another version.
std::uint32_t ticket_of_shapes(std::span<const std::byte> report);

/// A new request replaces the previous request.
class ProgramRequests {
 public:
  // ---- main loop ----

  /// Accepts a ForceReport. Returns false and counts a refusal if the report is invalid, too old or not from the
  /// driver. A report is too old if its pose is older than force_pose_age_maximum_ms. `pose_sequence` is the sequence
  /// number of the newest pose report.
  bool accept_force(std::span<const std::byte> report, bool is_of_driver, std::uint32_t pose_sequence);

  /// Accepts a LocalModelReport under the same conditions. The counters count forces and local models together.
  bool accept_local_model(std::span<const std::byte> report, bool is_of_driver, std::uint32_t pose_sequence);

  /// Accepts a ShapesReport of the driver. Returns `busy` if the interrupt has not accepted the previous report.
  /// Returns `malformed` for an invalid report.
  protocol::RequestResult accept_shapes(std::span<const std::byte> report);

  /// Removes all shapes and the local model, and lets the program force fade. Call this function after the claim has
  /// ended.
  void driver_gone();

  std::uint32_t forces_received() const { return forces_received_; }
  std::uint32_t forces_lost() const { return forces_lost_; }
  std::uint32_t forces_refused() const { return forces_refused_; }

  // ---- control interrupt ----

  /// Notes the position of the proxy and the depth of the probe, from which the main loop finds the first tangent
  /// planes.
  void note_proxy(const control::Vector3& proxy_m, float depth_m) {
    depth_m_.store(depth_m);
    proxy_x_m_.store(proxy_m.x);
    proxy_y_m_.store(proxy_m.y);
    proxy_z_m_.store(proxy_m.z);
  }

  /// Returns the newest request since the last call, or null. The result is valid until the next call.
  const control::ForceTarget* take_force() { return forces_.swap_if_offered() ? &forces_.used() : nullptr; }
  control::Shapes* take_shapes() { return shapes_.swap_if_offered() ? &shapes_.used() : nullptr; }
  control::LocalModel* take_local_model() { return models_.swap_if_offered() ? &models_.used() : nullptr; }

 private:
  bool count(std::optional<control::ForceTarget> target, bool is_of_driver, std::uint32_t pose_age_ms);
  void offer(const control::ForceTarget& target, std::uint32_t sequence);
  /// The coordinates may be from two periods. Each point gives tangent planes outside the objects.
  control::Vector3 proxy_m() const { return {proxy_x_m_.load(), proxy_y_m_.load(), proxy_z_m_.load()}; }

  Handover<control::ForceTarget> forces_;
  Handover<control::Shapes> shapes_;
  Handover<control::LocalModel> models_;
  Shared<float> proxy_x_m_{0.0f};
  Shared<float> proxy_y_m_{0.0f};
  Shared<float> proxy_z_m_{0.0f};
  Shared<float> depth_m_{0.0f};
  Materials materials_{};
  std::uint32_t forces_received_ = 0;
  std::uint32_t forces_lost_ = 0;
  std::uint32_t forces_refused_ = 0;
  std::optional<std::uint32_t> newest_sequence_;  ///< empty while no program sends forces
};

}  // namespace inkwell::link
