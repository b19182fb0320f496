#include "firmware/link/program_requests.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "protocol/directions.hpp"
#include "protocol/report_table.hpp"

namespace inkwell::link {

namespace {

using control::Vector3;
using Core = control::Solid::Core;
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

/// Rounding may reduce the smallest tip radius by one step.
constexpr float smallest_feature_radius_m = protocol::local_tip_radius_minimum_m - protocol::local_length_step_m;

/// The squares of smaller force components are finite.
constexpr float longest_force_N = 1e6f;

Vector3 shortened(const Vector3& force_N) {
  const float largest_N = std::fmax(std::fabs(force_N.x), std::fmax(std::fabs(force_N.y), std::fabs(force_N.z)));
  if (largest_N <= longest_force_N) return force_N;
  const float part = longest_force_N / largest_N;
  return part * force_N;
}

bool decode_properties(const protocol::MaterialEntry& entry, control::Surface& surface) {
  const float damping_maximum = info(Parameter::wall_damping_Ns_per_m).maximum;
  const bool is_valid = entry.stiffness_N_per_m > 0.0f &&
                        entry.stiffness_N_per_m <= info(Parameter::wall_stiffness_N_per_m).maximum &&
                        within(entry.damping_Ns_per_m, 0.0f, damping_maximum) &&
                        within(entry.static_friction, 0.0f, protocol::friction_maximum) &&
                        within(entry.dynamic_friction, 0.0f, entry.static_friction) &&
                        within(entry.viscosity_Ns_per_m, 0.0f, damping_maximum);
  if (!is_valid) return false;
  surface = {entry.stiffness_N_per_m, 1.0f / entry.stiffness_N_per_m, entry.damping_Ns_per_m,
             entry.static_friction,   entry.dynamic_friction,         entry.viscosity_Ns_per_m};
  return true;
}

bool decode_surface(const protocol::SurfaceEntry& entry, control::Surface& surface, std::uint32_t& life_periods) {
  life_periods = 0;
  if (entry.life_s == 0.0f) return true;  // no shape; other members are ignored
  const bool lasts = std::isinf(entry.life_s) && entry.life_s > 0.0f;
  if (!lasts && !within(entry.life_s, 0.0f, protocol::shape_life_maximum_s)) return false;
  life_periods = lasts ? control::Shapes::lasting
                       : 1 + static_cast<std::uint32_t>(entry.life_s * static_cast<float>(protocol::servo_rate_Hz));
  return decode_properties({entry.stiffness_N_per_m, entry.damping_Ns_per_m, entry.static_friction,
                            entry.dynamic_friction, entry.viscosity_Ns_per_m},
                           surface);
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

bool decode_sphere(const protocol::SphereEntry& entry, control::Solid& solid) {
  const float limit = protocol::shape_distance_maximum_m;
  if (!is_valid(entry.centre_m, limit) || !(entry.radius_m > 0.0f && entry.radius_m <= limit)) return false;
  solid = {.core = Core::point, .centre_m = vector_of(entry.centre_m), .radius_m = entry.radius_m};
  return true;
}

/// Sets the columns of the rotation matrix of a quaternion w, x, y, z.
bool decode_orientation(const float (&q)[4], std::array<Vector3, 3>& axes) {
  constexpr float longest = 1e3f, shortest_squared = 1e-6f;
  for (const float each : q)
    if (!within(each, -longest, longest)) return false;
  const float squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (squared < shortest_squared) return false;
  const float s = 2.0f / squared;
  axes = {
      Vector3{1.0f - s * (q[2] * q[2] + q[3] * q[3]), s * (q[1] * q[2] + q[0] * q[3]), s * (q[1] * q[3] - q[0] * q[2])},
      Vector3{s * (q[1] * q[2] - q[0] * q[3]), 1.0f - s * (q[1] * q[1] + q[3] * q[3]), s * (q[2] * q[3] + q[0] * q[1])},
      Vector3{s * (q[1] * q[3] + q[0] * q[2]), s * (q[2] * q[3] - q[0] * q[1]),
              1.0f - s * (q[1] * q[1] + q[2] * q[2])}};
  return true;
}

bool decode_solid(const protocol::SolidEntry& entry, control::Solid& solid) {
  using protocol::SolidKind;
  constexpr float rounding_m = protocol::solid_rounding_m;
  const float limit = protocol::shape_distance_maximum_m;
  std::array<Vector3, 3> axes;
  if (entry.kind > SolidKind::box || !is_valid(entry.centre_m, limit) || !decode_orientation(entry.orientation, axes))
    return false;
  const std::size_t sizes = entry.kind == SolidKind::sphere ? 1 : (entry.kind == SolidKind::box ? 3 : 2);
  const bool is_rounded = entry.kind == SolidKind::cylinder || entry.kind == SolidKind::box;
  for (std::size_t i = 0; i < sizes; ++i) {
    const float smallest_m = is_rounded ? rounding_m : 0.0f;
    if (!within(entry.size_m[i], smallest_m, limit) || entry.size_m[i] == 0.0f) return false;
  }
  const auto& [first_m, second_m, third_m] = entry.size_m;
  solid = {.centre_m = vector_of(entry.centre_m), .axes = {axes[2]}, .radius_m = first_m};
  switch (entry.kind) {
    case SolidKind::sphere: solid.core = Core::point; break;
    case SolidKind::capsule:
      solid.core = Core::segment;
      solid.half_m = {second_m};
      break;
    case SolidKind::cylinder:
      solid.core = Core::cylinder;
      solid.half_m = {second_m - rounding_m};
      solid.core_radius_m = first_m - rounding_m;
      solid.radius_m = rounding_m;
      break;
    case SolidKind::box:
      solid.core = Core::box;
      solid.axes = axes;
      solid.half_m = {first_m - rounding_m, second_m - rounding_m, third_m - rounding_m};
      solid.radius_m = rounding_m;
      break;
  }
  return true;
}

Vector3 vector_of(const std::int16_t (&steps)[3], float step) {
  return {step * static_cast<float>(steps[0]), step * static_cast<float>(steps[1]),
          step * static_cast<float>(steps[2])};
}

Vector3 vector_of(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

constexpr float length_m(int steps) { return protocol::local_length_step_m * static_cast<float>(steps); }

bool decode_feature(const protocol::FeatureEntry& entry, const protocol::LocalModelReport& report,
                    const Materials& materials, control::Feature& feature) {
  const Vector3 anchor_m = vector_of(report.anchor, protocol::local_anchor_step_m);
  const auto direction = protocol::decode_direction(entry.direction);
  feature = {};
  feature.surface = materials[entry.material];
  if (!(feature.surface.stiffness_N_per_m > 0.0f)) return false;
  feature.kind = entry.kind;
  feature.axis = vector_of(direction);
  switch (entry.kind) {
    case protocol::FeatureKind::plane: feature.centre_m = anchor_m - length_m(entry.lengths[0]) * feature.axis; break;
    case protocol::FeatureKind::sphere:
      feature.radius_m = length_m(entry.lengths[1]);
      feature.centre_m = anchor_m - (length_m(entry.lengths[0]) + feature.radius_m) * feature.axis;
      feature.axis = {};
      break;
    case protocol::FeatureKind::cylinder: {
      const auto across = protocol::across(direction);
      feature.radius_m = length_m(report.cylinder_radius);
      feature.centre_m = anchor_m + length_m(entry.lengths[0]) * vector_of(across[0]) +
                         length_m(entry.lengths[1]) * vector_of(across[1]);
      break;
    }
    default: return false;
  }
  if (entry.kind != protocol::FeatureKind::plane && feature.radius_m < smallest_feature_radius_m) return false;
  if (entry.moves == 0) return true;
  const Vector3 spin_rad_per_s = protocol::local_spin_step_rad_per_s * Vector3{static_cast<float>(report.spin[0]),
                                                                               static_cast<float>(report.spin[1]),
                                                                               static_cast<float>(report.spin[2])};
  feature.motion.velocity_m_per_s = vector_of(report.velocity, protocol::local_speed_step_m_per_s) +
                                    control::cross(spin_rad_per_s, feature.centre_m - anchor_m);
  feature.axis_rate_per_s = control::cross(spin_rad_per_s, feature.axis);
  return true;
}

/// Copies a part of a report. The report must contain the part.
template <class T>
T part_of(std::span<const std::byte> report, std::size_t offset) {
  T part;
  std::memcpy(&part, &report[offset], sizeof part);
  return part;
}

template <class T>
T entry_of(std::span<const std::byte> report, std::size_t offset, std::size_t number) {
  return part_of<T>(report, offset + number * sizeof(T));
}

std::uint32_t word_at(std::span<const std::byte> report, std::size_t offset) {
  std::uint32_t word = 0;
  if (report.size() >= offset + sizeof word) std::memcpy(&word, &report[offset], sizeof word);
  return word;
}

std::uint32_t half_at(std::span<const std::byte> report, std::size_t offset) {
  std::uint16_t half = 0;
  if (report.size() >= offset + sizeof half) std::memcpy(&half, &report[offset], sizeof half);
  return half;
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

bool decode_shapes(std::span<const std::byte> report, control::Shapes& shapes, Materials& materials) {
  using protocol::ShapesReport;
  if (report.size() < protocol::shapes_report_size(0)) return false;
  const auto header = part_of<std::array<std::uint8_t, 4>>(report, 0);  // id, version, planes, solids
  const std::size_t planes = header[2], solids = header[3];
  const std::size_t material_count = part_of<std::uint8_t>(report, offsetof(ShapesReport, material_count));
  if (header[1] != protocol::protocol_version || planes > protocol::shape_planes_maximum ||
      solids > protocol::shape_solids_maximum || material_count > protocol::materials_maximum ||
      report.size() < protocol::shapes_report_size(planes, solids, material_count))
    return false;
  shapes = {};
  constexpr std::size_t first_solid = control::Shapes::planes_maximum, sphere_number = protocol::shape_solids_maximum;
  // Decodes the surface of a shape, and then the shape unless its life is 0.
  const auto decode = [&shapes](const auto& entry, std::size_t shape, auto decode_geometry, auto& geometry) {
    std::uint32_t& life_periods = shapes.life_periods[shape];
    return decode_surface(entry.surface, shapes.surfaces[shape], life_periods) &&
           (life_periods == 0 || decode_geometry(entry, geometry));
  };
  const auto sphere = part_of<protocol::SphereEntry>(report, offsetof(ShapesReport, sphere));
  if (!decode(sphere, first_solid + sphere_number, decode_sphere, shapes.solids[sphere_number])) return false;
  for (std::size_t i = 0; i < planes; ++i) {
    const auto plane = entry_of<protocol::PlaneEntry>(report, offsetof(ShapesReport, planes), i);
    if (!decode(plane, i, decode_plane, shapes.planes[i])) return false;
  }
  for (std::size_t i = 0; i < solids; ++i) {
    const auto solid = entry_of<protocol::SolidEntry>(report, offsetof(ShapesReport, solids), i);
    if (!decode(solid, first_solid + i, decode_solid, shapes.solids[i])) return false;
  }
  const auto decode_material = [&](std::size_t i, control::Surface& surface) {
    return decode_properties(entry_of<protocol::MaterialEntry>(report, offsetof(ShapesReport, materials), i), surface);
  };
  control::Surface unused;
  for (std::size_t i = 0; i < material_count; ++i)
    if (!decode_material(i, unused)) return false;
  for (std::size_t i = 0; i < material_count; ++i) decode_material(i, materials[i]);
  return true;
}

std::optional<control::ForceTarget> decode_local_model(std::span<const std::byte> report, const Materials& materials,
                                                       control::LocalModel* model) {
  protocol::LocalModelReport local;
  if (report.size() < sizeof local || report.size() > longest_output_report) return std::nullopt;
  std::memcpy(&local, report.data(), sizeof local);
  const bool is_valid = local.mode <= ForceMode::instead_of_walls && local.interval_ms >= 1 &&
                        local.interval_ms <= protocol::force_interval_maximum_ms && local.life_ms >= 1 &&
                        local.life_ms <= protocol::local_model_life_maximum_ms &&
                        local.feature_count <= protocol::local_features_maximum;
  if (!is_valid) return std::nullopt;
  constexpr std::uint32_t millisecond_periods = protocol::servo_rate_Hz / 1000;
  control::LocalModel unused;
  control::LocalModel& decoded = model != nullptr ? *model : unused;
  decoded.count = local.feature_count;
  decoded.life_periods = local.life_ms * millisecond_periods;
  decoded.age_s = 0.0f;
  for (std::size_t i = 0; i < decoded.count; ++i)
    if (!decode_feature(local.features[i], local, materials, decoded.features[i])) return std::nullopt;
  const std::uint32_t interval_periods = local.interval_ms * millisecond_periods;
  return control::ForceTarget{vector_of(local.force, protocol::local_force_step_N), local.mode, interval_periods,
                              1.0f / static_cast<float>(interval_periods)};
}

std::uint32_t claim_of_force(std::span<const std::byte> report) {
  return word_at(report, offsetof(protocol::ForceReport, claim));
}

std::uint32_t claim_of_local_model(std::span<const std::byte> report) {
  return word_at(report, offsetof(protocol::LocalModelReport, claim));
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

/// Counts a received report. Returns false if the board must refuse it.
bool ProgramRequests::count(std::optional<control::ForceTarget> target, bool is_of_driver, std::uint32_t pose_age_ms) {
  ++forces_received_;
  if (target && is_of_driver && pose_age_ms <= protocol::force_pose_age_maximum_ms) return true;
  ++forces_refused_;
  return false;
}

void ProgramRequests::offer(const control::ForceTarget& target, std::uint32_t sequence) {
  // A larger gap in the sequence numbers indicates a new program, not lost reports.
  constexpr std::uint32_t longest_gap = 1000;
  if (newest_sequence_ && sequence - *newest_sequence_ - 1 < longest_gap)
    forces_lost_ += sequence - *newest_sequence_ - 1;
  newest_sequence_ = sequence;
  if (control::ForceTarget* next = forces_.next()) {
    *next = target;
    forces_.offer();
  } else {
    ++forces_lost_;
  }
}

bool ProgramRequests::accept_force(std::span<const std::byte> report, bool is_of_driver, std::uint32_t pose_sequence) {
  const auto target = decode_force(report);
  const std::uint32_t answered = word_at(report, offsetof(protocol::ForceReport, pose_sequence));
  if (!count(target, is_of_driver, pose_sequence - answered)) return false;
  offer(*target, word_at(report, offsetof(protocol::ForceReport, sequence)));
  if (target->mode == ForceMode::none) newest_sequence_.reset();
  return true;
}

bool ProgramRequests::accept_local_model(std::span<const std::byte> report, bool is_of_driver,
                                         std::uint32_t pose_sequence) {
  control::LocalModel* model = models_.next();
  const auto target = decode_local_model(report, materials_, model);
  const std::uint32_t sequence = half_at(report, offsetof(protocol::LocalModelReport, sequence));
  const std::uint32_t answered = half_at(report, offsetof(protocol::LocalModelReport, pose_sequence));
  if (!count(target, is_of_driver, (pose_sequence - answered) & 0xFFFFu)) return false;
  if (model != nullptr) find_tangents(*model, proxy_m());
  const std::uint32_t newest = newest_sequence_.value_or(sequence - 1);
  offer(*target, newest + ((sequence - newest) & 0xFFFFu));
  if (model != nullptr) models_.offer();
  return true;
}

protocol::RequestResult ProgramRequests::accept_shapes(std::span<const std::byte> report) {
  control::Shapes* next = shapes_.next();
  if (next == nullptr) return protocol::RequestResult::busy;
  if (!decode_shapes(report, *next, materials_)) return protocol::RequestResult::malformed;
  find_tangents(*next, proxy_m(), depth_m_.load());
  shapes_.offer();
  return protocol::RequestResult::accepted;
}

void ProgramRequests::driver_gone() {
  newest_sequence_.reset();
  forces_.withdraw() = {};
  forces_.offer();
  shapes_.withdraw() = {};
  shapes_.offer();
  models_.withdraw() = {};
  models_.offer();
}

}  // namespace inkwell::link
