// What goes over the HID interface. All structures are little-endian, as both ends are, and without gaps:
// only the command is packed, every other number lies where its type wants it.
//
//   device -> host   input report    PoseReport, one for each frame of the bus, a millisecond by the host's clock
//   host -> device   output report   CommandReport, ForceReport; any of them counts as a sign of life
//   host <- device   feature report  InformationReport, ParametersReport (get), TransactionReport,
//                                    FrameReport, ForceLawReport
//   host -> device   feature report  ParametersReport (set): one transaction, whole or not at all; ShapesReport,
//                                    likewise
//   both             feature report  those of the black box: protocol/black_box.hpp
//   host <- device   feature report  that of the self-test: protocol/self_test.hpp; that of the parameter store:
//                                    protocol/store.hpp, and the ParametersReport of what the next start would give
//   both             feature report  the claim of the program that drives the arm: protocol/driver.hpp
//   host <- device   feature report  the results of commands and shapes: protocol/driver.hpp
//
// Sizes and directions of all reports are in protocol/report_table.hpp. A report that is set may be longer than its
// used part; the device ignores the rest. Some hosts pad every report to the longest of its kind. A report that is read
// is filled with zeros up to its declared size, or to the length that the host asks for (HID 1.11, section 7.2.1).
//
// And, over an interface of its own, ControllerReport: what any program reads that knows joysticks.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <type_traits>

#include <protocol/faults.hpp>
#include <protocol/parameters.hpp>
#include <protocol/signals.hpp>
#include <protocol/supervision.hpp>

namespace inkwell::protocol {

static_assert(std::endian::native == std::endian::little, "the structures go over the wire as they lie in memory");

/// By how many versions this build is ahead of the tree; a test's firmware is (tests/target/next_protocol).
#ifndef INKWELL_PROTOCOL_VERSIONS_AHEAD
#define INKWELL_PROTOCOL_VERSIONS_AHEAD 0
#endif

/// Rises whenever a structure below, or the meaning of an id, changes.
inline constexpr std::uint16_t protocol_version = 16 + INKWELL_PROTOCOL_VERSIONS_AHEAD;

/// Rate of the control interrupt, of the scope, and of `time_periods` everywhere.
inline constexpr std::uint32_t servo_rate_Hz = 20'000;
inline constexpr float servo_period_s = 1.0f / servo_rate_Hz;
/// Frames of the bus in a second of the host.
inline constexpr std::uint32_t pose_rate_Hz = 1'000;

enum class ReportId : std::uint8_t {
  pose = 0x01,             ///< input
  command = 0x02,          ///< output
  force = 0x03,            ///< output
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

// clang-format off
/// X(bit, name, meaning)
#define INKWELL_FORCE_SOURCES(X)                                   \
  X(1, walls, "The force law of the board acts: the walls of the box in the default image.") \
  X(2, shapes, "Planes or a sphere placed by a program act on the probe.") \
  X(4, program, "A program on the PC sends forces.")
// clang-format on

/// Whose force the hand feels: bits of PoseReport::force_sources.
enum class ForceSource : std::uint8_t {
#define X(bit, name, ...) name = bit,
  INKWELL_FORCE_SOURCES(X)
#undef X
};

struct ForceSourceInfo {
  ForceSource source;
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto force_source_table = std::to_array<ForceSourceInfo>({
#define X(bit, name, meaning) {ForceSource::name, #name, meaning},
    INKWELL_FORCE_SOURCES(X)
#undef X
});

constexpr bool is_felt(std::uint8_t force_sources, ForceSource source) {
  return (force_sources & static_cast<std::uint8_t>(source)) != 0;
}

// clang-format off
/// X(bit, name, meaning)
#define INKWELL_LIMITS(X)                                          \
  X(1, force, "The force is limited by force_limit_N, or rises to it.")               \
  X(2, current, "A motor is at its current limit. All motor currents are scaled down together, so the force is weaker but keeps its direction.") \
  X(4, change, "The force changes at its largest rate, force_change_N_per_s.") \
  X(8, energy, "The energy reserve is empty: the force component along the motion is reduced.") \
  X(16, heat, "A hot motor is at its reduced current limit. All motor currents are scaled down together.") \
  X(32, speed, "The probe speed is close to speed_limit_m_per_s: the force component along the motion is reduced.")
// clang-format on

/// What makes the force smaller than what the hand touches: bits of PoseReport::limits. None of them is a fault.
enum class Limit : std::uint8_t {
#define X(bit, name, ...) name = bit,
  INKWELL_LIMITS(X)
#undef X
};

struct LimitInfo {
  Limit limit;
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto limit_table = std::to_array<LimitInfo>({
#define X(bit, name, meaning) {Limit::name, #name, meaning},
    INKWELL_LIMITS(X)
#undef X
});

constexpr bool is_reached(std::uint8_t limits, Limit limit) { return (limits & static_cast<std::uint8_t>(limit)) != 0; }

/// What a program's force has to do with that of the board's own force law, the walls of the box. Shapes are felt in
/// every mode.
enum class ForceMode : std::uint8_t {
  none = 0,              ///< the program has ended: its force fades
  beside_walls = 1,      ///< both are felt
  instead_of_walls = 2,  ///< the walls are not felt
};

/// Input report, the newest pose that there is just before the host asks: taken from the last control period that ends
/// before the start of the frame. What the host did not fetch is replaced, never sent late.
struct PoseReport {
  ReportId report_id = ReportId::pose;
  State state;
  Fault fault;
  std::uint8_t limits : 7;         ///< bits of Limit
  std::uint8_t is_referenced : 1;  ///< 1: it is known where the arm is; else joints and position mean nothing
  std::uint32_t sequence;          ///< frames of the bus since it runs; a gap is a frame without a report
  std::uint32_t time_periods;      ///< control periods since the board started; wraps after 59 hours
  float position_m[3];
  float gimbal_rad[3];
  float force_N[3];
  float joint_rad[3];
  std::uint8_t switches : 3;       ///< bits of Switch, 1 is pressed
  std::uint8_t driver_parity : 1;  ///< lowest bit of DriverReport::changes: it flips when another program drives
  std::uint8_t force_sources : 4;  ///< bits of ForceSource
  std::uint8_t servo_load;         ///< longest control interrupt since the last report, 255 is the whole period
  std::uint8_t command_token;      ///< token of the last command carried out
  std::uint8_t supply_dV;          ///< supply of the bridges in tenths of a volt
};

/// A step of ControllerReport: positions to 327 mm, angles to 3.2767 rad, further ones as these.
inline constexpr float controller_position_step_m = 1e-5f;
inline constexpr float controller_angle_step_rad = 1e-4f;
inline constexpr float controller_steps_maximum = 32767.0f;

/// Input report of the controller's interface, the only one there and so without an id: a multi-axis controller of the
/// HID usage tables, every controller_interval_ms if the host asks.
struct ControllerReport {
  std::int16_t position[3];  ///< x, y and z of the workspace
  std::int16_t angle[3];     ///< Rx, Ry and Rz: yaw, pitch and roll of the gimbal
  std::uint16_t buttons;     ///< bits button_1 and button_2 of Switch
};

enum class Command : std::uint8_t {
  heartbeat = 0,         ///< nothing but a sign of life
  enable_force = 1,      ///< from ready on, by a ramp
  disable_force = 2,     ///< by a ramp, soft_landing_s; a test ends at once
  clear_fault = 3,       ///< if its cause is gone
  select_signals = 4,    ///< starts the scope with these signals; none stops it
  test_current = 5,      ///< in `ready`, and no test runs: one pulse of current in a motor, then a rest as long
  test_voltage = 6,      ///< likewise: one pulse of voltage on a motor, then a rest as long
  stop = 7,              ///< switches force and test off at once
  self_test = 8,         ///< in `unreferenced`, `ready`, and in a fault before the first test that passes
  store_parameters = 9,  ///< keeps the parameters as they are now over a start; where may_store() (protocol/store.hpp)
  factory_reset = 10,    ///< forgets what is stored, and gives every parameter its default; likewise
};

inline constexpr std::size_t scope_signals_maximum = 32;
inline constexpr float test_duration_maximum_s = 0.1f;

#pragma pack(push, 1)

struct SignalSelection {
  std::uint8_t count;  ///< 0..scope_signals_maximum
  std::uint8_t signals[scope_signals_maximum];
};

struct TestPulse {
  std::uint8_t motor;  ///< 1..3
  /// A or V; bounded by the current limit or the voltage limit, and by the current that makes force_limit_N in this
  /// pose.
  float amplitude;
  float duration_s;  ///< 0..test_duration_maximum_s; the pulse ends before if it moved energy_reserve_J
};

/// Output report. The device does not acknowledge a report of another version or length, a command that is not valid,
/// or one that comes over endpoint 0 while the command queue is full. Otherwise `token` comes back in
/// PoseReport::command_token when the command has been carried out. While a program drives the arm, `stop` is the only
/// command that is accepted from other programs.
struct CommandReport {
  ReportId report_id = ReportId::command;
  Command command;
  std::uint8_t version = protocol_version;
  std::uint8_t token;
  std::uint32_t claim;   ///< of the program that sends it; 0 if it has none
  std::uint32_t ticket;  ///< chosen by the program; RequestResultsReport names the result by it. 0 asks for no result
  union {
    SignalSelection selection;  ///< select_signals
    TestPulse test;             ///< test_current, test_voltage
  };
};

#pragma pack(pop)

/// The longest interval between two reports of a program that the board interpolates.
inline constexpr std::uint8_t force_interval_maximum_ms = 50;

/// Output report, up to one in a millisecond: the force that a program wants at the probe. The board moves to it in a
/// straight line over the program's own interval, keeps it below the force limit and its change below
/// program_force_change_N_per_s, and lets it fade program_force_expiry_s after the last report. A force that is not
/// finite, an unknown mode, an interval out of range, a claim that does not drive the arm or an old pose is refused and
/// counted.
struct ForceReport {
  ReportId report_id = ReportId::force;
  ForceMode mode;
  std::uint8_t version = protocol_version;
  std::uint8_t interval_ms;     ///< 1..force_interval_maximum_ms
  std::uint32_t claim;          ///< of the program that drives the arm
  std::uint32_t sequence;       ///< one more each time; a gap is counted as lost
  std::uint32_t pose_sequence;  ///< PoseReport::sequence of the newest pose that the program has received
  float force_N[3];             ///< on the hand, workspace axes
};

/// A force that answers an older pose is refused: the program no longer knows the position of the hand.
inline constexpr std::uint32_t force_pose_age_maximum_ms = 100;

/// From this heat on a motor's current limit falls, to its continuous current where the heat is 1.
inline constexpr float motor_heat_holds_back_from = 0.85f;
/// At this heat, which holding back should not let come, the force goes off.
inline constexpr float motor_heat_fault = 1.25f;

/// From this part of speed_limit_m_per_s on, what of the force drives the motion gives way.
inline constexpr float speed_holds_back_from = 0.8f;
/// From this part on all of it does.
inline constexpr float speed_drives_no_more_from = 0.9f;

/// Letters of a board's name, which is that of its folder in boards/.
inline constexpr std::size_t board_name_maximum = 31;

/// The name in a field of a report or an image; empty if it is no name: without an end, or with what cannot be printed.
constexpr std::string_view board_name(const char (&field)[board_name_maximum + 1]) {
  const std::string_view name(field, std::find(field, std::end(field), '\0'));
  const bool is_sound = name.size() <= board_name_maximum &&
                        std::ranges::all_of(name, [](char letter) { return letter > ' ' && letter <= '~'; });
  return is_sound ? name : std::string_view{};
}

/// The version of the protocol from which on the device names its board.
inline constexpr std::uint16_t first_version_with_board = 12;

/// Feature report: who the device is, and what it has counted since it started. What stands before the hashes keeps its
/// place in every later version, so that a companion of another one can still say whom it met.
struct InformationReport {
  ReportId report_id = ReportId::information;
  std::uint8_t reserved = 0;
  std::uint16_t version = protocol_version;
  std::uint8_t firmware_version[4];    ///< major, minor, patch, 0
  char board[board_name_maximum + 1];  ///< the board that the firmware is for, zeros behind it
  std::uint32_t parameter_table_hash;  ///< protocol::parameter_table_hash of the firmware
  std::uint32_t signal_table_hash;     ///< protocol::signal_table_hash of the firmware
  std::uint32_t servo_rate_Hz;
  std::uint32_t processor_clock_Hz;
  std::uint32_t servo_cycles_longest;   ///< longest control interrupt since the start
  std::uint32_t scope_samples_dropped;  ///< because the host did not read
  std::uint32_t pose_reports_dropped;   ///< frames in which a host that otherwise polled did not
  std::uint32_t servo_overruns;
  std::uint32_t force_reports;          ///< received since the start, refused ones included
  std::uint32_t force_reports_lost;     ///< gaps in their sequence
  std::uint32_t force_reports_late;     ///< came more than a millisecond after their interval
  std::uint32_t force_reports_refused;  ///< what they said was not sound
  std::uint32_t reset_cause;            ///< RCC_CSR bits 31..24 as found at start-up
  float motor_heat[3];                  ///< now; 1 is what the continuous current leads to
};

enum class ParameterOperation : std::uint8_t {
  set = 0,               ///< the entries take effect together, the other parameters stay
  restore_defaults = 1,  ///< every parameter gets its default; no entries
  restore_stored = 2,    ///< every parameter gets what the next start would give it; no entries
};

struct ParameterEntry {
  std::uint16_t id;
  std::uint16_t reserved = 0;
  float value;
};

inline constexpr std::size_t parameter_entries_maximum = 96;
static_assert(parameter_count + force_law_parameters_maximum <= parameter_entries_maximum);

/// Feature report. On get, the entries are those of the table in its order, then those of the force law. On set,
/// only the used part has to be sent: parameters_report_size(count) bytes. The same with ReportId::stored, get only,
/// tells what the next start would give each parameter: what is stored, or its default; its operation is
/// restore_stored.
struct ParametersReport {
  ReportId report_id = ReportId::parameters;
  ParameterOperation operation;
  std::uint16_t version = protocol_version;
  std::uint16_t count;
  std::uint16_t ticket = 0;  ///< chosen by the program; comes back in the TransactionReport
  std::uint32_t claim = 0;   ///< of the program that sends it; 0 if it has none, and in answers
  ParameterEntry entries[parameter_entries_maximum];
};

/// Feature report: what became of the last transaction.
struct TransactionReport {
  ReportId report_id = ReportId::transaction;
  Refusal refusal;
  std::uint16_t parameter_id;        ///< the one that was refused, else 0
  float value;                       ///< the value that was refused, else 0
  std::uint32_t transactions;        ///< received since the start, refused ones included
  std::uint32_t applied_at_periods;  ///< control period at which the last accepted one took effect
  std::uint16_t ticket;              ///< ParametersReport::ticket of that transaction
  std::uint16_t reserved;
};

/// Feature report: when the newest frame of the bus began, by the board's clock. Two of them tell how fast the host's
/// milliseconds and the board's control periods run against each other.
struct FrameReport {
  ReportId report_id = ReportId::frame;
  std::uint8_t is_known;       ///< 0: no frame runs, or the board has no time for it yet; then the rest is 0
  std::uint16_t frame_number;  ///< 0..2047, as it came with the start of frame
  std::uint32_t sequence;      ///< PoseReport::sequence of the report that was meant for this frame
  std::uint32_t time_periods;  ///< the control period in which the frame began
  std::uint32_t time_cycles;   ///< processor cycles from the begin of that period to the begin of the frame
};

/// How a shape feels.
struct SurfaceEntry {
  float stiffness_N_per_m;  ///< above 0, to the maximum of wall_stiffness_N_per_m
  float damping_Ns_per_m;   ///< 0 to the maximum of wall_damping_Ns_per_m
  float static_friction;    ///< 0..friction_maximum, a part of the normal force
  float dynamic_friction;   ///< 0..static_friction
  /// 0..shape_life_maximum_s from when it takes effect; infinite until the claim ends; 0 for a shape that is not there.
  float life_s;
};

struct PlaneEntry {
  float point_m[3];  ///< any point of it
  float normal[3];   ///< into the free space, of any length but 0
  SurfaceEntry surface;
};

struct SphereEntry {
  float centre_m[3];
  float radius_m;  ///< the free space is outside
  SurfaceEntry surface;
};

inline constexpr std::size_t shape_planes_maximum = 8;
inline constexpr float shape_life_maximum_s = 10.0f;
inline constexpr float shape_distance_maximum_m = 10.0f;  ///< of every length and coordinate
inline constexpr float friction_maximum = 3.0f;

/// Feature report, set: the shapes from now on, each in a place of its own. They take the place of all that were there
/// at the start of one control period, without a jump of the force. Only the used part has to be sent:
/// shapes_report_size(plane_count) bytes. A report that is not valid, or of a program that does not drive the arm, is
/// refused whole; RequestResultsReport has the result. All shapes end with the claim.
struct ShapesReport {
  ReportId report_id = ReportId::shapes;
  std::uint8_t version = protocol_version;
  std::uint8_t plane_count;  ///< 0..shape_planes_maximum
  std::uint8_t reserved = 0;
  std::uint32_t claim;   ///< of the program that drives the arm
  std::uint32_t ticket;  ///< chosen by the program; RequestResultsReport names the result by it. 0 asks for no result
  SphereEntry sphere;
  PlaneEntry planes[shape_planes_maximum];
};

/// Feature report: the rows that the image's force law adds to the tables. Behind this head stand, each text with a
/// zero at its end: the law's name and what it is; of each parameter three floats (minimum, maximum, default), then
/// name, unit and help; of each signal name, unit and help. Its parameters' ids rise by one from force_law_first_id,
/// and they are real numbers; its signals follow the table's last and are floats.
struct ForceLawReport {
  ReportId report_id = ReportId::force_law;
  std::uint8_t parameter_count;  ///< 0..force_law_parameters_maximum
  std::uint8_t signal_count;     ///< 0..force_law_signals_maximum
  std::uint8_t reserved = 0;
  std::uint16_t size;  ///< of all of it, up to force_law_report_maximum
};

/// Some kernels take no report that is longer.
inline constexpr std::size_t force_law_report_maximum = 2048;

constexpr std::size_t shapes_report_size(std::size_t plane_count) {
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
static_assert(sizeof(InformationReport) == 104);
static_assert(sizeof(ParameterEntry) == 8);
static_assert(sizeof(ParametersReport) == 12 + 8 * parameter_entries_maximum);
static_assert(sizeof(TransactionReport) == 20);
static_assert(sizeof(FrameReport) == 16);
static_assert(sizeof(ForceLawReport) == 6);
static_assert(sizeof(SurfaceEntry) == 20 && sizeof(PlaneEntry) == 44 && sizeof(SphereEntry) == 36);
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

/// Equal on both ends exactly if ids, names and units agree (FNV-1a of the tables).
inline constexpr std::uint32_t parameter_table_hash = detail::hash_parameters(parameter_table);
inline constexpr std::uint32_t signal_table_hash = detail::hash_signals(signal_table);

}  // namespace inkwell::protocol
