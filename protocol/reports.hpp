// Reports of the HID interface. All structures are little-endian and have no padding. CommandReport is packed; all
// other structures are naturally aligned.
//
//   PoseReport: input report, one per bus frame (1 ms of the host's clock).
//   CommandReport, ForceReport, LocalModelReport: output reports. Each output report restarts the host timeout.
//   InformationReport, TransactionReport, FrameReport, ForceLawReport: feature reports (get).
//   ParametersReport: feature report (get and set). The board applies a ParametersReport completely or not at all.
//   ShapesReport: feature report (set). The board applies a ShapesReport completely or not at all.
//   Black box: feature reports in protocol/black_box.hpp.
//   Self-test: feature report in protocol/self_test.hpp.
//   Parameter store: feature report in protocol/store.hpp.
//   Parameters after the next start: a ParametersReport (get).
//   Claim of the driver: feature reports in protocol/driver.hpp.
//   Results of commands and shapes: feature report in protocol/driver.hpp.
//
// Sizes and directions of all reports are in protocol/report_table.hpp. The device ignores bytes after the used part of
// a written report. Some hosts pad every report to the longest report length. The device pads reports with zeros to the
// declared size or the requested length (HID 1.11, section 7.2.1).
//
// ControllerReport has a separate interface. Every program that supports joysticks can read ControllerReport.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <type_traits>

#include "protocol/faults.hpp"
#include "protocol/parameters.hpp"
#include "protocol/signals.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::protocol {

static_assert(std::endian::native == std::endian::little, "the structures are transmitted in their memory layout");

/// Number of protocol versions by which this build is ahead of the source tree. The test firmware in
/// tests/target/next_protocol sets INKWELL_PROTOCOL_VERSIONS_AHEAD.
#ifndef INKWELL_PROTOCOL_VERSIONS_AHEAD
#define INKWELL_PROTOCOL_VERSIONS_AHEAD 0
#endif

/// Increase the protocol version when a report structure or the meaning of an id changes.
inline constexpr std::uint16_t protocol_version = 17 + INKWELL_PROTOCOL_VERSIONS_AHEAD;

/// Rate of the control interrupt and the scope. Fields named `time_periods` are numbers of control periods.
inline constexpr std::uint32_t servo_rate_Hz = 20'000;
inline constexpr float servo_period_s = 1.0f / servo_rate_Hz;
/// Bus frames per second of the host's clock.
inline constexpr std::uint32_t pose_rate_Hz = 1'000;

enum class ReportId : std::uint8_t {
  pose = 0x01,             ///< input
  command = 0x02,          ///< output
  force = 0x03,            ///< output
  local_model = 0x04,      ///< output
  information = 0x10,      ///< feature, get
  parameters = 0x11,       ///< feature, get and set
  transaction = 0x12,      ///< feature, get
  frame = 0x13,            ///< feature, get
  shapes = 0x14,           ///< feature, set
  force_law = 0x15,        ///< feature, get
  black_box = 0x16,        ///< feature, get: protocol/black_box.hpp
  black_box_rows = 0x17,   ///< feature, get and set
  self_test = 0x18,        ///< feature, get: protocol/self_test.hpp
  store = 0x19,            ///< feature, get: protocol/store.hpp
  stored = 0x1A,           ///< feature, get: a ParametersReport
  driver = 0x1B,           ///< feature, get and set: protocol/driver.hpp
  request_results = 0x1C,  ///< feature, get: protocol/driver.hpp
};

/// Bits of PoseReport::switches.
enum class Switch : std::uint8_t { button_1 = 1, button_2 = 2, inkwell = 4 };
inline constexpr std::size_t switch_count = 3;

constexpr bool is_closed(std::uint8_t switches, Switch which) {
  return (switches & static_cast<std::uint8_t>(which)) != 0;
}

enum class ForceSource : std::uint8_t;
enum class Limit : std::uint8_t;

struct ForceSourceInfo {
  ForceSource source;
  std::string_view name;
  const char* meaning;
};

struct LimitInfo {
  Limit limit;
  std::string_view name;
  const char* meaning;
};

}  // namespace inkwell::protocol

#include <tables/force_sources.hpp>  // ForceSource, force_source_table
#include <tables/limits.hpp>         // Limit, limit_table

namespace inkwell::protocol {

constexpr bool is_felt(std::uint8_t force_sources, ForceSource source) {
  return (force_sources & static_cast<std::uint8_t>(source)) != 0;
}

constexpr bool is_reached(std::uint8_t limits, Limit limit) { return (limits & static_cast<std::uint8_t>(limit)) != 0; }

/// Combination of a program's force with the board's force law. The hand feels shapes in every mode.
enum class ForceMode : std::uint8_t {
  none = 0,              ///< the program has ended, and its force fades
  beside_walls = 1,      ///< the hand feels the program's force and the walls
  instead_of_walls = 2,  ///< the hand does not feel the walls
};

/// Input report: the newest pose at the time of the poll. The pose belongs to the last control period that ends before
/// the start of the bus frame. A newer pose replaces a pose that the host did not read.
struct PoseReport {
  ReportId report_id = ReportId::pose;
  State state;
  Fault fault;
  std::uint8_t limits : 7;         ///< bits of Limit
  std::uint8_t is_referenced : 1;  ///< 0: the position of the arm is unknown, and joints and position are invalid
  std::uint32_t sequence;          ///< number of bus frames; a gap is a bus frame without a report
  std::uint32_t time_periods;      ///< control periods since start-up; wraps after 59 hours
  float position_m[3];
  float gimbal_rad[3];
  float force_N[3];
  float joint_rad[3];
  std::uint8_t switches : 3;       ///< bits of Switch, 1 is closed
  std::uint8_t driver_parity : 1;  ///< lowest bit of DriverReport::changes; it changes with the driver
  std::uint8_t force_sources : 4;  ///< bits of ForceSource
  std::uint8_t servo_load;         ///< longest control interrupt since the last report; 255 is the whole control period
  std::uint8_t command_token;      ///< token of the last command that was carried out
  std::uint8_t supply_dV;          ///< supply voltage of the bridges in units of 0.1 V
};

/// Units of ControllerReport. Positions are limited to +-327 mm and angles to +-3.2767 rad.
inline constexpr float controller_position_step_m = 1e-5f;
inline constexpr float controller_angle_step_rad = 1e-4f;
inline constexpr float controller_steps_maximum = 32767.0f;

/// Input report of the controller interface: a multi-axis controller as defined in the HID usage tables. The report has
/// no id, because the interface has no other report. The host can read the report every controller_interval_ms.
struct ControllerReport {
  std::int16_t position[3];  ///< x, y and z in the workspace
  std::int16_t angle[3];     ///< Rx, Ry and Rz: yaw, pitch and roll of the gimbal
  std::uint16_t buttons;     ///< bits button_1 and button_2 of Switch
};

enum class Command : std::uint8_t {
  heartbeat = 0,       ///< only a sign of life
  enable_force = 1,    ///< in `ready` or `landing`; the force ramps up
  disable_force = 2,   ///< the force ramps down in soft_landing_s; a test pulse stops immediately
  clear_fault = 3,     ///< no effect while the cause of the fault persists
  select_signals = 4,  ///< starts the scope with these signals; none stops it
  test_current = 5,    ///< in `ready` without a running test: one current pulse in a motor, then a rest of equal length
  test_voltage = 6,    ///< in `ready` without a running test: one voltage pulse on a motor, then a rest of equal length
  stop = 7,            ///< switches force and test off immediately
  self_test = 8,       ///< in `unreferenced`, `ready`, or a fault before the first passed self-test
  store_parameters = 9,  ///< writes the current parameter values to flash, where may_store() (protocol/store.hpp)
  factory_reset = 10,    ///< erases the stored parameters and sets the defaults, where may_store()
};

/// Signals that the scope transmits in every control period. A selection of more signals is a bit mask.
inline constexpr std::size_t scope_signals_maximum = 32;
/// SignalSelection::count of a selection with a bit mask.
inline constexpr std::uint8_t selected_by_mask = 0xFF;
inline constexpr float test_duration_maximum_s = 0.1f;

#pragma pack(push, 1)

struct SignalSelection {
  std::uint8_t count;  ///< 0..scope_signals_maximum, or selected_by_mask
  /// Ids of the signals. With selected_by_mask, bit k of byte i selects the signal 8 * i + k.
  std::uint8_t signals[scope_signals_maximum];
};

struct TestPulse {
  std::uint8_t motor;  ///< 1..3
  /// Pulse height in A or V. The current of the pulse is limited to the motor's limit and to the current for
  /// force_limit_N.
  float amplitude;
  float duration_s;  ///< 0..test_duration_maximum_s; the pulse stops early when it has delivered energy_reserve_J
};

/// Output report. PoseReport::command_token equals `token` after the command has been carried out. The device does not
/// acknowledge an invalid report. While the command queue is full, the device does not acknowledge a command on
/// endpoint 0. While a program drives the arm, other programs can send only commands that need no claim
/// (needs_claim()).
struct CommandReport {
  ReportId report_id = ReportId::command;
  Command command;
  std::uint8_t version = protocol_version;
  std::uint8_t token;
  std::uint32_t claim;  ///< claim of the sender; 0 if it has none
  /// Chosen by the program. RequestResultsReport lists the result under the ticket. If the ticket is 0, the result is
  /// not recorded.
  std::uint32_t ticket;
  union {
    SignalSelection selection;  ///< select_signals
    TestPulse test;             ///< test_current, test_voltage
  };
};

#pragma pack(pop)

/// The board interpolates between two force reports over at most this interval.
inline constexpr std::uint8_t force_interval_maximum_ms = 50;

/// Output report: the force of a program at the probe. A program sends at most one report per millisecond. The board
/// interpolates linearly to the requested force within `interval_ms`. The parameters force_limit_N and
/// program_force_change_N_per_s limit the force. The force fades if no report arrives for program_force_expiry_s. The
/// device refuses and counts invalid reports. The device refuses a report if the pose is older than
/// force_pose_age_maximum_ms or if the claim is not the driver's.
struct ForceReport {
  ReportId report_id = ReportId::force;
  ForceMode mode;
  std::uint8_t version = protocol_version;
  std::uint8_t interval_ms;     ///< 1..force_interval_maximum_ms
  std::uint32_t claim;          ///< claim of the driver
  std::uint32_t sequence;       ///< increases by one per report; a gap is counted as lost
  std::uint32_t pose_sequence;  ///< PoseReport::sequence of the newest pose that the program has received
  float force_N[3];             ///< force on the hand, workspace axes
};

/// Largest permitted age of the pose in a force report. The device refuses a force for an older pose, because the hand
/// may have moved since that pose.
inline constexpr std::uint32_t force_pose_age_maximum_ms = 100;

/// Above this heat, the current limit of a motor falls. At heat 1 the limit equals the continuous current.
inline constexpr float motor_heat_limits_from = 0.85f;
/// At this heat, a fault switches the force off. The reduced current limit normally prevents this heat.
inline constexpr float motor_heat_fault = 1.25f;

/// Above this fraction of speed_limit_m_per_s, the force component along the motion is reduced.
inline constexpr float speed_limits_from = 0.8f;
/// Above this fraction of speed_limit_m_per_s, the force component along the motion is zero.
inline constexpr float speed_stops_driving_from = 0.9f;

/// Longest board name. A board has the name of its folder in boards/.
inline constexpr std::size_t board_name_maximum = 31;

/// Returns the board name in a field of a report or an image. Returns an empty name if the field is not terminated or
/// not printable.
constexpr std::string_view board_name(const char (&field)[board_name_maximum + 1]) {
  const std::string_view name(field, std::find(field, std::end(field), '\0'));
  const bool is_valid = name.size() <= board_name_maximum &&
                        std::ranges::all_of(name, [](char letter) { return letter > ' ' && letter <= '~'; });
  return is_valid ? name : std::string_view{};
}

/// First protocol version with a board name in InformationReport.
inline constexpr std::uint16_t first_version_with_board = 12;

/// Feature report: identity and counters of the device. The position of the fields before the hashes is the same in all
/// later versions. A companion of another version can therefore identify the device.
struct InformationReport {
  ReportId report_id = ReportId::information;
  std::uint8_t reserved = 0;
  std::uint16_t version = protocol_version;
  std::uint8_t firmware_version[4];    ///< major, minor, patch, 0
  char board[board_name_maximum + 1];  ///< target board of the firmware, padded with zeros
  std::uint32_t parameter_table_hash;  ///< protocol::parameter_table_hash of the firmware
  std::uint32_t signal_table_hash;     ///< protocol::signal_table_hash of the firmware
  std::uint32_t servo_rate_Hz;
  std::uint32_t processor_clock_Hz;
  std::uint32_t servo_cycles_longest;   ///< longest control interrupt since start-up
  std::uint32_t scope_samples_dropped;  ///< samples lost because the host did not read
  std::uint32_t pose_reports_dropped;   ///< bus frames without a poll, from a host that polls otherwise
  std::uint32_t servo_overruns;
  std::uint32_t force_reports;          ///< received since start-up, including refused ones
  std::uint32_t force_reports_lost;     ///< gaps in the sequence of force reports
  std::uint32_t force_reports_late;     ///< received more than 1 ms after the end of the previous report's interval
  std::uint32_t force_reports_refused;  ///< reports with invalid values
  std::uint32_t reset_cause;            ///< RCC_CSR bits 31..24, as read at start-up
  float motor_heat[3];                  ///< heat now; 1 is the heat at the continuous current
  std::uint32_t image_check;            ///< checksum in the last word of the flashed image, as in CrashFacts
};

enum class ParameterOperation : std::uint8_t {
  set = 0,               ///< all entries take effect in the same period; other parameters do not change
  restore_defaults = 1,  ///< sets every parameter to its default; without entries
  restore_stored = 2,    ///< sets every parameter to its value after the next start; without entries
};

struct ParameterEntry {
  std::uint16_t id;
  std::uint16_t reserved = 0;
  float value;
};

inline constexpr std::size_t parameter_entries_maximum = 96;
static_assert(parameter_count + force_law_parameters_maximum <= parameter_entries_maximum);

/// Feature report. The host reads all parameters in table order, followed by the parameters of the force law. To set
/// parameters, the host sends at least parameters_report_size(count) bytes. A report with ReportId::stored (get only)
/// contains the operation restore_stored and the parameter values after the next start.
struct ParametersReport {
  ReportId report_id = ReportId::parameters;
  ParameterOperation operation;
  std::uint16_t version = protocol_version;
  std::uint16_t count;
  std::uint16_t ticket = 0;  ///< chosen by the program; TransactionReport repeats it
  std::uint32_t claim = 0;   ///< claim of the sender; 0 if it has none, and in answers
  ParameterEntry entries[parameter_entries_maximum];
};

/// Feature report: result of the last transaction.
struct TransactionReport {
  ReportId report_id = ReportId::transaction;
  Refusal refusal;
  std::uint16_t parameter_id;        ///< id of the refused parameter, otherwise 0
  float value;                       ///< refused value, otherwise 0
  std::uint32_t transactions;        ///< transactions received since start-up, including refused ones
  std::uint32_t applied_at_periods;  ///< control period in which the last accepted transaction took effect
  std::uint16_t ticket;              ///< ParametersReport::ticket of the last transaction
  std::uint16_t reserved;
};

/// Feature report: board time at the start of the newest bus frame. Two frame reports show the ratio of the host clock
/// to the board clock.
struct FrameReport {
  ReportId report_id = ReportId::frame;
  std::uint8_t is_known;  ///< 0: there is no bus frame, or its time is not known yet; then all further fields are 0
  std::uint16_t frame_number;  ///< 0..2047, from the start-of-frame packet
  std::uint32_t sequence;      ///< PoseReport::sequence of the report for this bus frame
  std::uint32_t time_periods;  ///< control period in which the bus frame began
  std::uint32_t time_cycles;   ///< processor cycles from the start of that period to the start of the bus frame
};

/// Surface properties of a shape.
struct SurfaceEntry {
  float stiffness_N_per_m;   ///< above 0, to the maximum of wall_stiffness_N_per_m
  float damping_Ns_per_m;    ///< 0 to the maximum of wall_damping_Ns_per_m
  float static_friction;     ///< 0..friction_maximum, relative to the normal force
  float dynamic_friction;    ///< 0..static_friction
  float viscosity_Ns_per_m;  ///< 0 to the maximum of wall_damping_Ns_per_m; tangential, at most the normal force
  /// Life of the shape after it takes effect, 0..shape_life_maximum_s. A shape with infinite life exists until the
  /// claim ends. A shape with `life_s` 0 does not exist.
  float life_s;
};

struct PlaneEntry {
  float point_m[3];  ///< any point of the plane
  float normal[3];   ///< points into the free space; any length except 0
  SurfaceEntry surface;
};

struct SphereEntry {
  float centre_m[3];
  float radius_m;  ///< the free space is outside
  SurfaceEntry surface;
};

enum class SolidKind : std::uint8_t { sphere = 0, capsule = 1, cylinder = 2, box = 3 };

/// Solid that the probe cannot enter. The edges of cylinders and boxes are rounded with solid_rounding_m.
struct SolidEntry {
  SolidKind kind;
  std::uint8_t reserved[3] = {};
  float centre_m[3];
  /// Quaternion w, x, y, z from the axes of the solid to the workspace, with any length except 0. The axis of a capsule
  /// or cylinder is z.
  float orientation[4];
  /// Sphere: radius. Capsule: radius and half length of the axis without the caps. Cylinder: radius and half length.
  /// Box: half lengths along x, y and z. Unused entries are ignored.
  float size_m[3];
  SurfaceEntry surface;
};

/// Properties of a surface in local models, with the ranges of SurfaceEntry.
struct MaterialEntry {
  float stiffness_N_per_m;
  float damping_Ns_per_m;
  float static_friction;
  float dynamic_friction;
  float viscosity_Ns_per_m;
};

inline constexpr std::size_t shape_planes_maximum = 8;
inline constexpr std::size_t shape_solids_maximum = 16;
inline constexpr std::size_t materials_maximum = 16;
/// The tip of a stylus has no sharp features of this size, and a proxy needs a normal at each edge.
inline constexpr float solid_rounding_m = 0.0005f;
inline constexpr float shape_life_maximum_s = 10.0f;
inline constexpr float shape_distance_maximum_m = 10.0f;  ///< limit of every length and coordinate
inline constexpr float friction_maximum = 3.0f;

/// Feature report, set: the new shapes and the materials of the following local models. The new shapes replace all
/// previous shapes without a jump of the force. The host sends at least shapes_report_size() bytes. The device refuses
/// the whole report if it is invalid or does not come from the driver. RequestResultsReport has the result. All shapes
/// are removed when the claim ends.
struct ShapesReport {
  ReportId report_id = ReportId::shapes;
  std::uint8_t version = protocol_version;
  std::uint8_t plane_count;  ///< 0..shape_planes_maximum
  std::uint8_t solid_count;  ///< 0..shape_solids_maximum
  std::uint32_t claim;       ///< claim of the driver
  /// Chosen by the program. RequestResultsReport lists the result under the ticket. If the ticket is 0, the result is
  /// not recorded.
  std::uint32_t ticket;
  std::uint8_t material_count;  ///< 0..materials_maximum; 0 keeps the previous materials
  std::uint8_t reserved[3] = {};
  SphereEntry sphere;
  PlaneEntry planes[shape_planes_maximum];
  SolidEntry solids[shape_solids_maximum];
  MaterialEntry materials[materials_maximum];
};

inline constexpr std::size_t local_features_maximum = 3;

enum class FeatureKind : std::uint8_t { plane = 0, cylinder = 1, sphere = 2 };

#pragma pack(push, 1)

/// Feature of a local model: a surface that the center of the tip cannot pass. The free space of a cylinder or a sphere
/// is outside. Lengths are relative to the anchor.
struct FeatureEntry {
  FeatureKind kind : 2;
  std::uint8_t moves : 1;     ///< 1: the feature moves with the velocity and the spin of the report
  std::uint8_t material : 4;  ///< index of a material in the newest ShapesReport with materials
  std::uint8_t reserved : 1;
  /// Octahedral coordinates of a unit vector (decode_direction()). Plane, sphere: normal at the anchor. Cylinder: axis.
  std::int16_t direction[2];
  /// In local_length_step_m. Plane, sphere: distance from the surface to the anchor, and radius of the sphere.
  /// Cylinder: vector from the anchor to the axis along the two vectors of across().
  std::int16_t lengths[2];
};

/// Output report: a local model of the objects at the tip, and the force of a program. A program sends at most one
/// report per millisecond. The model replaces the previous model. The force obeys the rules of ForceReport. The device
/// refuses and counts a report if a value is invalid, if the claim is not the driver's, or if the pose is older than
/// force_pose_age_maximum_ms. The protocol version is not repeated here, because the claim requires the version.
struct LocalModelReport {
  ReportId report_id = ReportId::local_model;
  ForceMode mode;
  std::uint8_t feature_count;     ///< 0..local_features_maximum
  std::uint8_t interval_ms;       ///< 1..force_interval_maximum_ms, for the force
  std::uint8_t life_ms;           ///< 1..local_model_life_maximum_ms; the model fades if no report arrives in this time
  std::int8_t spin[3];            ///< angular velocity of the moving object, in local_spin_step_rad_per_s
  std::uint32_t claim;            ///< claim of the driver
  std::uint16_t sequence;         ///< low half of the sequence of force reports
  std::uint16_t pose_sequence;    ///< low half of PoseReport::sequence of the newest pose that the program has received
  std::int16_t anchor[3];         ///< in local_anchor_step_m, in the workspace
  std::int16_t velocity[3];       ///< of the moving object at the anchor, in local_speed_step_m_per_s
  std::int16_t force[3];          ///< force on the hand, in local_force_step_N
  std::uint16_t cylinder_radius;  ///< of all cylinders of the report, in local_length_step_m
  FeatureEntry features[local_features_maximum];
  std::uint8_t reserved;
};

#pragma pack(pop)

inline constexpr float local_length_step_m = 2e-6f;
inline constexpr float local_anchor_step_m = 20e-6f;
inline constexpr float local_speed_step_m_per_s = 2e-4f;
inline constexpr float local_spin_step_rad_per_s = 0.25f;
inline constexpr float local_force_step_N = 1e-3f;
/// The board does not extrapolate a moving object for a longer time.
inline constexpr std::uint8_t local_model_life_maximum_ms = 20;
/// Smallest radius of the tip in a local model. At a sharp edge or corner the surface would have no normal.
inline constexpr float local_tip_radius_minimum_m = 0.0005f;

/// Feature report: table rows of the image's force law. The name and the description of the force law follow this
/// header. Each parameter has three floats (minimum, maximum, default), a name, a unit and a help text. Each signal has
/// a name, a unit and a help text. Every text is zero-terminated. The ids of the parameters count up from
/// force_law_first_id. The signals follow the last row of the signal table.
struct ForceLawReport {
  ReportId report_id = ReportId::force_law;
  std::uint8_t parameter_count;  ///< 0..force_law_parameters_maximum
  std::uint8_t signal_count;     ///< 0..force_law_signals_maximum
  std::uint8_t reserved = 0;
  std::uint16_t size;  ///< size of the whole report, up to force_law_report_maximum
};

/// Largest size of a ForceLawReport. Some kernels do not accept longer reports.
inline constexpr std::size_t force_law_report_maximum = 2048;

/// Size of the used part of a ShapesReport.
constexpr std::size_t shapes_report_size(std::size_t plane_count, std::size_t solid_count = 0,
                                         std::size_t material_count = 0) {
  if (material_count != 0) return offsetof(ShapesReport, materials) + material_count * sizeof(MaterialEntry);
  if (solid_count != 0) return offsetof(ShapesReport, solids) + solid_count * sizeof(SolidEntry);
  return offsetof(ShapesReport, planes) + plane_count * sizeof(PlaneEntry);
}
constexpr std::size_t parameters_report_size(std::size_t count) {
  return offsetof(ParametersReport, entries) + count * sizeof(ParameterEntry);
}

static_assert(sizeof(PoseReport) == 64);
static_assert(sizeof(ControllerReport) == 14);
static_assert(sizeof(SignalSelection) == 33 && sizeof(TestPulse) == 9);
static_assert(sizeof(CommandReport) == 45);
static_assert(sizeof(ForceReport) == 28);
static_assert(sizeof(InformationReport) == 108);
static_assert(sizeof(ParameterEntry) == 8);
static_assert(sizeof(ParametersReport) == 12 + 8 * parameter_entries_maximum);
static_assert(sizeof(TransactionReport) == 20);
static_assert(sizeof(FrameReport) == 16);
static_assert(sizeof(ForceLawReport) == 6);
static_assert(sizeof(SurfaceEntry) == 24 && sizeof(PlaneEntry) == 48 && sizeof(SphereEntry) == 40);
static_assert(sizeof(SolidEntry) == 68 && sizeof(MaterialEntry) == 20 && sizeof(ShapesReport) == 1848);
static_assert(sizeof(FeatureEntry) == 9 && sizeof(LocalModelReport) == 64);
static_assert(std::is_trivially_copyable_v<PoseReport> && std::is_trivially_copyable_v<ParametersReport>);

namespace detail {
constexpr std::uint32_t fnv1a(std::uint32_t hash, std::string_view text) {
  for (char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
  return (hash ^ 0u) * 16777619u;
}
constexpr std::uint32_t hash_number(std::uint32_t hash, std::uint32_t number) {
  for (int i = 0; i < 4; ++i, number >>= 8) hash = (hash ^ (number & 0xFFu)) * 16777619u;
  return hash;
}
template <class Table>
constexpr std::uint32_t hash_parameters(const Table& table) {
  std::uint32_t hash = 2166136261u;
  for (const auto& row : table) hash = fnv1a(fnv1a(hash_number(hash, row.id), row.name), row.unit);
  return hash;
}
template <class Table>
constexpr std::uint32_t hash_signals(const Table& table) {
  std::uint32_t hash = 2166136261u;
  for (const auto& row : table)
    hash = fnv1a(fnv1a(hash_number(hash, row.id + 256u * static_cast<std::uint32_t>(row.wire)), row.name), row.unit);
  return hash;
}
}  // namespace detail

/// FNV-1a hashes of the tables. The hashes are equal in firmware and PC program if ids, names, units and signal
/// encodings agree.
inline constexpr std::uint32_t parameter_table_hash = detail::hash_parameters(parameter_table);
inline constexpr std::uint32_t signal_table_hash = detail::hash_signals(signal_table);

}  // namespace inkwell::protocol
