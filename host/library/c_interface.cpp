// The C interface: every call is guarded, so that no exception leaves the library and each ends in a result.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <device/fault_text.hpp>
#include <device/nearest_name.hpp>

#include "arm.hpp"

using namespace inkwell::library;
namespace device = inkwell::device;
namespace protocol = inkwell::protocol;
namespace control = inkwell::control;

struct inkwell_arm {
  explicit inkwell_arm(const std::string& address) : arm(address) {}
  Arm arm;
};

namespace {

thread_local std::string error_text;
/// The newest pose that this thread has waited for, for each arm.
thread_local std::map<const inkwell_arm*, std::uint32_t> seen_sequences;

inkwell_result fail(inkwell_result result, const char* sentence) {
  try {
    error_text = sentence;
  } catch (...) {
    error_text.clear();
  }
  return result;
}

template <class Action>
inkwell_result guarded(Action action) noexcept {
  try {
    action();
    return INKWELL_OK;
  } catch (const device::NoDevice& error) {
    return fail(INKWELL_NO_DEVICE, error.what());
  } catch (const BadArgument& error) {
    return fail(INKWELL_BAD_ARGUMENT, error.what());
  } catch (const device::BadAddress& error) {
    return fail(INKWELL_BAD_ARGUMENT, error.what());
  } catch (const TimedOut& error) {
    return fail(INKWELL_TIMED_OUT, error.what());
  } catch (const NotNow& error) {
    return fail(INKWELL_REFUSED, error.what());
  } catch (const device::Refused& error) {
    return fail(INKWELL_REFUSED, error.what());
  } catch (const device::NoPermission& error) {
    return fail(INKWELL_NO_PERMISSION, error.what());
  } catch (const device::Incompatible& error) {
    return fail(INKWELL_INCOMPATIBLE, error.what());
  } catch (const device::Disconnected& error) {
    return fail(INKWELL_DISCONNECTED, error.what());
  } catch (const device::InUse& error) {
    return fail(INKWELL_IN_USE, error.what());
  } catch (const std::exception& error) {
    return fail(INKWELL_FAILED, error.what());
  } catch (...) {
    return fail(INKWELL_FAILED, "Something failed that nobody expected. Report this with the version of the library.");
  }
}

template <class Pointer>
Pointer required(Pointer pointer, const char* what) {
  if (pointer == nullptr) throw BadArgument(fmt::format("{} is NULL. Give one.", what));
  return pointer;
}

Arm& arm_of(inkwell_arm* arm) { return required(arm, "The arm")->arm; }

template <std::size_t size>
void copy(const std::string& text, char (&to)[size]) {
  std::strncpy(to, text.c_str(), size - 1);
  to[size - 1] = '\0';
}

std::array<float, 3> floats(const double (&values)[3]) {
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

/// The vector's three values, `stride` places apart.
void put(const control::Vector3& vector, double* to, std::size_t stride) {
  to[0] = vector.x;
  to[stride] = vector.y;
  to[2 * stride] = vector.z;
}

device::Surface surface_of(const inkwell_surface& surface) {
  return {static_cast<float>(surface.stiffness_N_per_m), static_cast<float>(surface.damping_Ns_per_m),
          static_cast<float>(surface.static_friction), static_cast<float>(surface.dynamic_friction),
          static_cast<float>(surface.life_s)};
}

protocol::Parameter parameter_named(const char* name) {
  if (const auto parameter = protocol::find_parameter(std::string_view(required(name, "A parameter's name"))))
    return *parameter;
  throw BadArgument(fmt::format("There is no parameter {}. Did you mean {}?", name,
                                device::nearest_name(protocol::parameter_table, name)));
}

protocol::Signal signal_named(const char* name) {
  if (const auto signal = protocol::find_signal(std::string_view(required(name, "A signal's name")))) return *signal;
  throw BadArgument(
      fmt::format("There is no signal {}. Did you mean {}?", name, device::nearest_name(protocol::signal_table, name)));
}

/// The tables of the protocol are not ended by zeros everywhere, so that the names are kept here.
template <class Row, class Table, class Fill>
std::vector<Row> rows(const Table& table, Fill fill) {
  std::vector<Row> rows;
  for (const auto& entry : table) rows.push_back(fill(entry));
  return rows;
}

const std::vector<inkwell_parameter>& parameter_rows() {
  // The table's texts are literals, so they end in a zero.
  static const auto table = rows<inkwell_parameter>(protocol::parameter_table, [](const auto& row) {
    return inkwell_parameter{row.name.data(), row.unit.data(), row.help.data(),
                             row.minimum,     row.maximum,     row.default_value};
  });
  return table;
}

const std::vector<inkwell_signal>& signal_rows() {
  static const auto table = rows<inkwell_signal>(protocol::signal_table, [](const auto& row) {
    return inkwell_signal{row.name.data(), row.unit.data(), row.help.data()};
  });
  return table;
}

}  // namespace

const char* inkwell_version(void) { return INKWELL_VERSION; }
const char* inkwell_error_text(void) { return error_text.c_str(); }

// ---- devices -----------------------------------------------------------------------------------------------

inkwell_result inkwell_list_devices(inkwell_device* devices, size_t capacity, size_t* count) {
  return guarded([&] {
    required(count, "The count");
    if (capacity > 0) required(devices, "The list of devices");
    const auto found = list_devices();
    *count = found.size();
    std::copy_n(found.begin(), std::min(capacity, found.size()), devices);
  });
}

inkwell_result inkwell_kind_of_address(const char* address, inkwell_address_kind* kind) {
  return guarded([&] {
    required(kind, "The place for the kind");
    switch (device::parse_address(required(address, "The address")).kind) {
      case device::Address::Kind::usb: *kind = INKWELL_ON_USB; break;
      case device::Address::Kind::usbip: *kind = INKWELL_AT_SERVER; break;
      case device::Address::Kind::own_board: *kind = INKWELL_OWN_BOARD; break;
    }
  });
}

inkwell_result inkwell_open(const char* address, inkwell_arm** arm) {
  return guarded([&] { *required(arm, "The place for the arm") = new inkwell_arm(address == nullptr ? "" : address); });
}

void inkwell_close(inkwell_arm* arm) {
  guarded([&] {
    seen_sequences.erase(arm);
    delete arm;
  });
}

inkwell_result inkwell_get_information(inkwell_arm* arm, inkwell_information* information) {
  return guarded([&] {
    required(information, "The place for the information");
    const auto& endpoint = arm_of(arm).endpoint();
    const auto told = arm_of(arm).device().information();
    *information = {};
    copy(told.serial_number, information->serial_number);
    copy(endpoint.product, information->product);
    copy(told.firmware_version, information->firmware_version);
    information->is_virtual = endpoint.is_virtual ? 1 : 0;
    information->servo_rate_Hz = told.report.servo_rate_Hz;
    information->servo_cycles_longest = told.report.servo_cycles_longest;
    information->force_reports = told.report.force_reports;
    information->force_reports_lost = told.report.force_reports_lost;
    information->force_reports_late = told.report.force_reports_late;
    information->force_reports_refused = told.report.force_reports_refused;
    std::copy_n(told.report.motor_heat, 3, information->motor_heat);
  });
}

// ---- pose --------------------------------------------------------------------------------------------------

inkwell_result inkwell_get_pose(inkwell_arm* arm, inkwell_pose* pose) {
  return guarded([&] { *required(pose, "The place for the pose") = arm_of(arm).pose(); });
}

inkwell_result inkwell_wait_for_pose(inkwell_arm* arm, double timeout_s, inkwell_pose* pose) {
  return guarded([&] {
    required(pose, "The place for the pose");
    const auto seen = seen_sequences.find(required(arm, "The arm"));
    *pose =
        arm->arm.wait_for_pose(timeout_s, seen == seen_sequences.end() ? std::nullopt : std::optional(seen->second));
    seen_sequences[arm] = pose->sequence;
  });
}

inkwell_result inkwell_forward_kinematics(inkwell_arm* arm, const double joint_rad[3], double position_m[3],
                                          double jacobian[9]) {
  return guarded([&] {
    control::Triple joints{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isfinite(required(joint_rad, "The list of joint angles")[i]))
        throw BadArgument("A joint angle is not a finite number. Give angles in radians.");
      joints[i] = static_cast<float>(joint_rad[i]);
    }
    const auto pose = arm_of(arm).forward_kinematics(joints);
    if (position_m != nullptr) put(pose.position_m, position_m, 1);
    if (jacobian == nullptr) return;
    for (std::size_t joint = 0; joint < 3; ++joint) put(pose.jacobian.column[joint], jacobian + joint, 3);
  });
}

const char* inkwell_fault_text(int fault) {
  thread_local std::string text;
  const auto result = guarded([&] {
    const bool known = fault >= 0 && fault <= 0xFFFF;
    text = device::fault_line(static_cast<protocol::Fault>(known ? fault : 0xFFFF));
  });
  return result == INKWELL_OK ? text.c_str() : "";
}

// ---- force -------------------------------------------------------------------------------------------------

inkwell_result inkwell_enable_force(inkwell_arm* arm, double timeout_s) {
  return guarded([&] { arm_of(arm).enable_force(timeout_s); });
}

inkwell_result inkwell_disable_force(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).disable_force(); });
}

inkwell_result inkwell_clear_fault(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).device().send(protocol::Command::clear_fault); });
}

inkwell_result inkwell_set_force_mode(inkwell_arm* arm, inkwell_force_mode mode) {
  return guarded([&] {
    if (mode != INKWELL_BESIDE_WALLS && mode != INKWELL_INSTEAD_OF_WALLS)
      throw BadArgument(fmt::format("{} is no mode of force. Give INKWELL_BESIDE_WALLS or INKWELL_INSTEAD_OF_WALLS.",
                                    static_cast<int>(mode)));
    arm_of(arm).set_force_mode(static_cast<protocol::ForceMode>(mode));
  });
}

inkwell_result inkwell_set_force(inkwell_arm* arm, const double force_N[3]) {
  return guarded([&] {
    required(force_N, "The force");
    arm_of(arm).set_force({force_N[0], force_N[1], force_N[2]});
  });
}

inkwell_result inkwell_start_servo(inkwell_arm* arm, inkwell_servo servo, void* user) {
  return guarded([&] {
    required(servo, "The servo");
    arm_of(arm).start_servo([arm, servo, user](const inkwell_pose& pose, double(&force_N)[3]) {
      return servo(arm, &pose, force_N, user) == 0;
    });
  });
}

inkwell_result inkwell_stop_servo(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).stop_servo(); });
}

int inkwell_servo_is_running(inkwell_arm* arm) {
  bool runs = false;
  guarded([&] { runs = arm_of(arm).servo_is_running(); });
  return runs ? 1 : 0;
}

// ---- shapes ------------------------------------------------------------------------------------------------

inkwell_result inkwell_place_shapes(inkwell_arm* arm, const inkwell_plane* planes, size_t plane_count,
                                    const inkwell_sphere* sphere) {
  return guarded([&] {
    if (plane_count > INKWELL_PLANES_MAXIMUM)
      throw BadArgument(
          fmt::format("{} planes are too many. Give the {} nearest.", plane_count, INKWELL_PLANES_MAXIMUM));
    if (plane_count > 0) required(planes, "The list of planes");
    device::Shapes shapes;
    for (std::size_t i = 0; i < plane_count; ++i)
      if (planes[i].surface.life_s != 0.0)
        shapes.planes[i] =
            device::Plane{floats(planes[i].point_m), floats(planes[i].normal), surface_of(planes[i].surface)};
    if (sphere != nullptr && sphere->surface.life_s != 0.0)
      shapes.sphere =
          device::Sphere{floats(sphere->centre_m), static_cast<float>(sphere->radius_m), surface_of(sphere->surface)};
    try {
      device::shapes_report(shapes);
    } catch (const device::Error& error) {
      throw BadArgument(error.what());
    }
    arm_of(arm).place_shapes(shapes);
  });
}

// ---- parameters --------------------------------------------------------------------------------------------

size_t inkwell_parameter_count(void) { return protocol::parameter_count; }

const inkwell_parameter* inkwell_parameter_at(size_t index) {
  const inkwell_parameter* row = nullptr;
  guarded([&] { row = index < parameter_rows().size() ? &parameter_rows()[index] : nullptr; });
  return row;
}

inkwell_result inkwell_get_parameter(inkwell_arm* arm, const char* name, double* value) {
  return guarded([&] {
    required(value, "The place for the value");
    const auto parameter = parameter_named(name);
    *value = arm_of(arm).device().parameters()[parameter];
  });
}

inkwell_result inkwell_set_parameters(inkwell_arm* arm, const char* const* names, const double* values, size_t count) {
  return guarded([&] {
    if (count > 0) required(names, "The list of names"), required(values, "The list of values");
    std::vector<device::ParameterChange> changes;
    for (std::size_t i = 0; i < count; ++i)
      changes.emplace_back(parameter_named(names[i]), static_cast<float>(values[i]));
    arm_of(arm).set_parameters(changes);
  });
}

// ---- the hand of a virtual board ---------------------------------------------------------------------------

inkwell_result inkwell_move_virtual_hand(inkwell_arm* arm, const double target_m[3], double stiffness_N_per_m) {
  return guarded([&] {
    required(target_m, "The target");
    const device::Vector3 target{target_m[0], target_m[1], target_m[2]};
    auto& control = arm_of(arm).virtual_hand();
    control.hand({.holds = true,
                  .target_m = target,
                  .stiffness_N_per_m = stiffness_N_per_m,
                  .damping_Ns_per_m = 0.01 * stiffness_N_per_m});
    control.dock(false);
  });
}

inkwell_result inkwell_release_virtual_hand(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).virtual_hand().hand({}); });
}

inkwell_result inkwell_press_virtual_buttons(inkwell_arm* arm, int button_1, int button_2) {
  return guarded([&] { arm_of(arm).virtual_hand().buttons(button_1 != 0, button_2 != 0); });
}

// ---- scope and recording -----------------------------------------------------------------------------------

size_t inkwell_signal_count(void) { return protocol::signal_count; }

const inkwell_signal* inkwell_signal_at(size_t index) {
  const inkwell_signal* row = nullptr;
  guarded([&] { row = index < signal_rows().size() ? &signal_rows()[index] : nullptr; });
  return row;
}

inkwell_result inkwell_select_signals(inkwell_arm* arm, const char* const* names, size_t count) {
  return guarded([&] {
    if (count > 0) required(names, "The list of names");
    std::vector<protocol::Signal> signals;
    for (std::size_t i = 0; i < count; ++i) signals.push_back(signal_named(names[i]));
    arm_of(arm).select_signals(signals);
  });
}

inkwell_result inkwell_read_scope(inkwell_arm* arm, double timeout_s, float* values, uint32_t* periods, size_t capacity,
                                  size_t* count, uint64_t* lost) {
  return guarded([&] {
    required(count, "The count");
    if (capacity > 0) required(values, "The place for the samples");
    *count = 0;
    if (lost != nullptr) *lost = 0;
    const auto samples = arm_of(arm).read_scope(timeout_s, capacity);
    if (!samples) return;
    *count = samples->count;
    std::copy(samples->values.begin(), samples->values.end(), values);
    for (std::size_t i = 0; periods != nullptr && i < samples->count; ++i)
      periods[i] = samples->first_period + static_cast<std::uint32_t>(i);
    if (lost != nullptr) *lost = samples->lost_before;
  });
}

inkwell_result inkwell_start_recording(inkwell_arm* arm, const char* path) {
  return guarded([&] { arm_of(arm).start_recording(required(path, "The file's name")); });
}

inkwell_result inkwell_stop_recording(inkwell_arm* arm, uint64_t* samples, uint64_t* lost) {
  return guarded([&] {
    const auto status = arm_of(arm).stop_recording();
    if (samples != nullptr) *samples = status.samples;
    if (lost != nullptr) *lost = status.lost;
  });
}
