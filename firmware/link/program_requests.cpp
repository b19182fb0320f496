#include "firmware/link/program_requests.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "protocol/report_table.hpp"

namespace inkwell::link {

namespace {

using control::Vector3;
using protocol::ForceMode;
using protocol::Parameter;

/// False for NaN.
bool within(float value, float low, float high) { return value >= low && value <= high; }

bool is_valid(const float (&coordinates)[3], float limit) {
  return within(coordinates[0], -limit, limit) && within(coordinates[1], -limit, limit) &&
         within(coordinates[2], -limit, limit);
}

Vector3 vector_of(const float (&coordinates)[3]) { return {coordinates[0], coordinates[1], coordinates[2]}; }

constexpr std::size_t longest_output_report = protocol::longest_report(protocol::ReportKind::output);

/// The squares of smaller force components are finite.
constexpr float longest_force_N = 1e6f;

Vector3 shortened(const Vector3& force_N) {
  const float largest_N = std::fmax(std::fabs(force_N.x), std::fmax(std::fabs(force_N.y), std::fabs(force_N.z)));
  if (largest_N <= longest_force_N) return force_N;
  const float part = longest_force_N / largest_N;
  return part * force_N;
}

bool decode_surface(const protocol::SurfaceEntry& entry, control::Surface& surface, std::uint32_t& life_periods) {
  life_periods = 0;
  if (entry.life_s == 0.0f) return true;  // no shape; other members are ignored
  const bool lasts = std::isinf(entry.life_s) && entry.life_s > 0.0f;
  const bool is_valid = entry.stiffness_N_per_m > 0.0f &&
                        entry.stiffness_N_per_m <= info(Parameter::wall_stiffness_N_per_m).maximum &&
                        within(entry.damping_Ns_per_m, 0.0f, info(Parameter::wall_damping_Ns_per_m).maximum) &&
                        within(entry.static_friction, 0.0f, protocol::friction_maximum) &&
                        within(entry.dynamic_friction, 0.0f, entry.static_friction) &&
                        (within(entry.life_s, 0.0f, protocol::shape_life_maximum_s) || lasts);
  if (!is_valid) return false;
  surface = {entry.stiffness_N_per_m, 1.0f / entry.stiffness_N_per_m, entry.damping_Ns_per_m, entry.static_friction,
             entry.dynamic_friction};
  life_periods = lasts ? control::Shapes::lasting
                       : 1 + static_cast<std::uint32_t>(entry.life_s * static_cast<float>(protocol::servo_rate_Hz));
  return true;
}

bool decode_plane(const protocol::PlaneEntry& entry, control::Plane& plane) {
  const float limit = protocol::shape_distance_maximum_m;
  if (!is_valid(entry.point_m, limit) || !is_valid(entry.normal, limit)) return false;
  const Vector3 direction = vector_of(entry.normal);
  const float squared = control::dot(direction, direction);
  constexpr float shortest_squared = 1e-12f;
  if (squared < shortest_squared) return false;
  plane.normal = (1.0f / std::sqrt(squared)) * direction;
  plane.offset_m = control::dot(plane.normal, vector_of(entry.point_m));
  return true;
}

bool decode_sphere(const protocol::SphereEntry& entry, control::Sphere& sphere) {
  const float limit = protocol::shape_distance_maximum_m;
  if (!is_valid(entry.centre_m, limit) || !(entry.radius_m > 0.0f && entry.radius_m <= limit)) return false;
  sphere = {vector_of(entry.centre_m), entry.radius_m, entry.radius_m * entry.radius_m};
  return true;
}

std::uint32_t word_at(std::span<const std::byte> report, std::size_t offset) {
  std::uint32_t word = 0;
  if (report.size() >= offset + sizeof word) std::memcpy(&word, &report[offset], sizeof word);
  return word;
}

}  // namespace

std::optional<control::ForceTarget> decode_force(std::span<const std::byte> report) {
  protocol::ForceReport force;
  if (report.size() < sizeof force || report.size() > longest_output_report) return std::nullopt;
  std::memcpy(&force, report.data(), sizeof force);
  const bool is_valid = force.version == protocol::protocol_version && force.mode <= ForceMode::instead_of_walls &&
                        force.interval_ms >= 1 && force.interval_ms <= protocol::force_interval_maximum_ms &&
                        std::isfinite(force.force_N[0]) && std::isfinite(force.force_N[1]) &&
                        std::isfinite(force.force_N[2]);
  if (!is_valid) return std::nullopt;
  const std::uint32_t interval_periods = force.interval_ms * (protocol::servo_rate_Hz / 1000);
  return control::ForceTarget{shortened(vector_of(force.force_N)), force.mode, interval_periods,
                              1.0f / static_cast<float>(interval_periods)};
}

bool decode_shapes(std::span<const std::byte> report, control::Shapes& shapes) {
  protocol::ShapesReport set;
  if (report.size() < protocol::shapes_report_size(0)) return false;
  std::memcpy(&set, report.data(), std::min(report.size(), sizeof set));
  if (set.version != protocol::protocol_version || set.plane_count > protocol::shape_planes_maximum ||
      report.size() < protocol::shapes_report_size(set.plane_count))
    return false;
  shapes = {};
  if (!decode_surface(set.sphere.surface, shapes.surfaces[0], shapes.life_periods[0])) return false;
  if (shapes.life_periods[0] != 0 && !decode_sphere(set.sphere, shapes.sphere)) return false;
  for (std::size_t i = 0; i < set.plane_count; ++i) {
    if (!decode_surface(set.planes[i].surface, shapes.surfaces[1 + i], shapes.life_periods[1 + i])) return false;
    if (shapes.life_periods[1 + i] != 0 && !decode_plane(set.planes[i], shapes.planes[i])) return false;
  }
  return true;
}

std::uint32_t claim_of_force(std::span<const std::byte> report) {
  return word_at(report, offsetof(protocol::ForceReport, claim));
}

std::uint32_t claim_of_shapes(std::span<const std::byte> report) {
  return word_at(report, offsetof(protocol::ShapesReport, claim));
}

std::uint32_t ticket_of_shapes(std::span<const std::byte> report) {
  constexpr std::size_t version_at = offsetof(protocol::ShapesReport, version);
  const bool is_of_this_version =
      report.size() > version_at && report[version_at] == static_cast<std::byte>(protocol::protocol_version);
  return is_of_this_version ? word_at(report, offsetof(protocol::ShapesReport, ticket)) : 0;
}

bool ProgramRequests::accept_force(std::span<const std::byte> report, bool is_of_driver, std::uint32_t pose_sequence) {
  ++forces_received_;
  const auto target = decode_force(report);
  const std::uint32_t answered = word_at(report, offsetof(protocol::ForceReport, pose_sequence));
  if (!target || !is_of_driver || pose_sequence - answered > protocol::force_pose_age_maximum_ms) {
    ++forces_refused_;
    return false;
  }
  const std::uint32_t sequence = word_at(report, offsetof(protocol::ForceReport, sequence));
  // A larger gap in the sequence numbers indicates a new program, not lost reports.
  constexpr std::uint32_t longest_gap = 1000;
  if (newest_sequence_ && sequence - *newest_sequence_ - 1 < longest_gap)
    forces_lost_ += sequence - *newest_sequence_ - 1;
  newest_sequence_ = sequence;
  if (target->mode == ForceMode::none) newest_sequence_.reset();
  if (control::ForceTarget* next = forces_.next()) {
    *next = *target;
    forces_.offer();
  } else {
    ++forces_lost_;
  }
  return true;
}

protocol::RequestResult ProgramRequests::accept_shapes(std::span<const std::byte> report) {
  control::Shapes* next = shapes_.next();
  if (next == nullptr) return protocol::RequestResult::busy;
  if (!decode_shapes(report, *next)) return protocol::RequestResult::malformed;
  shapes_.offer();
  return protocol::RequestResult::accepted;
}

void ProgramRequests::driver_gone() {
  newest_sequence_.reset();
  if (control::ForceTarget* next = forces_.next()) {
    *next = {};
    forces_.offer();
  }
  if (control::Shapes* next = shapes_.next()) {
    *next = {};
    shapes_.offer();
  }
}

}  // namespace inkwell::link
