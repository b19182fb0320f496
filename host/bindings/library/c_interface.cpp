// Functions of the C interface for devices, poses and force. The functions for parameters, signals and the scope are in
// c_tables.cpp.
#include <algorithm>
#include <cmath>
#include <string>

#include "host/client/device/fault_text.hpp"
#include "protocol/faults.hpp"

#include "host/bindings/library/address.hpp"
#include "host/bindings/library/c_guard.hpp"
#include "host/bindings/library/text_copy.hpp"

using namespace inkwell::library;
namespace control = inkwell::control;
namespace device = inkwell::device;
namespace protocol = inkwell::protocol;

namespace {

/// Writes the vector's values at intervals of `stride` elements.
void put(const control::Vector3& vector, double* to, std::size_t stride) {
  to[0] = vector.x;
  to[stride] = vector.y;
  to[2 * stride] = vector.z;
}

constexpr double open_timeout_s = 60;

}  // namespace

const char* inkwell_version(void) { return INKWELL_VERSION; }

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

inkwell_result inkwell_list_names(inkwell_named_arm* names, size_t capacity, size_t* count) {
  return guarded([&] {
    required(count, "The count");
    if (capacity > 0) required(names, "The list of names");
    const auto found = list_names();
    *count = found.size();
    std::copy_n(found.begin(), std::min(capacity, found.size()), names);
  });
}

inkwell_result inkwell_kind_of_address(const char* address, inkwell_address_kind* kind) {
  return guarded([&] {
    required(kind, "The pointer to the kind");
    switch (device::parse_address(required(address, "The address")).kind) {
      case device::Address::Kind::usb: *kind = INKWELL_ON_USB; break;
      case device::Address::Kind::usbip: *kind = INKWELL_AT_SERVER; break;
      case device::Address::Kind::own_board: *kind = INKWELL_OWN_BOARD; break;
    }
  });
}

inkwell_result inkwell_open(const char* address, inkwell_arm** arm) {
  return guarded([&] {
    const inkwell::process::NoCancellationPoints whole;
    *required(arm, "The pointer to the arm") = new inkwell_arm(address == nullptr ? "" : address, open_timeout_s);
  });
}

inkwell_result inkwell_close(inkwell_arm* arm) {
  return guarded([&] {
    if (arm == nullptr) return;
    if (!arm->origin.is_here()) return;  // a forked child has no threads to wait for
    const inkwell::process::NoCancellationPoints whole;
    if (arm->arm.servo().is_caller())
      throw NotNow("A servo cannot close its own arm. Stop the servo, and close the arm in another thread.");
    delete arm;
  });
}

inkwell_result inkwell_get_information(inkwell_arm* arm, inkwell_information* information) {
  return guarded([&] {
    required(information, "The pointer to the information");
    const auto& endpoint = arm_of(arm).endpoint();
    const auto device_information = arm_of(arm).device().information();
    *information = {};
    copy_text(device_information.serial_number, information->serial_number);
    copy_text(endpoint.product, information->product);
    copy_text(device_information.firmware_version, information->firmware_version);
    information->is_virtual = endpoint.is_virtual ? 1 : 0;
    information->servo_rate_Hz = device_information.report.servo_rate_Hz;
    information->servo_cycles_longest = device_information.report.servo_cycles_longest;
    information->force_reports = device_information.report.force_reports;
    information->force_reports_lost = device_information.report.force_reports_lost;
    information->force_reports_late = device_information.report.force_reports_late;
    information->force_reports_refused = device_information.report.force_reports_refused;
    std::copy_n(device_information.report.motor_heat, 3, information->motor_heat);
  });
}

inkwell_result inkwell_get_board_name(inkwell_arm* arm, char name[INKWELL_BOARD_NAME_SIZE]) {
  return guarded([&] {
    required(name, "The pointer to the name");
    const auto device_information = arm_of(arm).device().information();
    name[device_information.board_name.copy(name, INKWELL_BOARD_NAME_SIZE - 1)] = '\0';
  });
}

// ---- pose --------------------------------------------------------------------------------------------------

inkwell_result inkwell_get_pose(inkwell_arm* arm, inkwell_pose* pose) {
  return guarded([&] {
    required(pose, "The pointer to the pose");
    return arm_of(arm).read([&](const PoseFeed::Seen& last) { *pose = last.pose; }, refuse);
  });
}

inkwell_result inkwell_wait_for_pose(inkwell_arm* arm, double timeout_s, inkwell_pose* pose) {
  return guarded([&] {
    required(pose, "The pointer to the pose");
    *pose = arm_of(arm).last().pose;  // the result if no pose arrives
    const auto answer = arm->seen.take_force() ? Turns::Answer::loop : Turns::Answer::none;
    *pose = arm_of(arm).wait_for_pose(timeout_s, arm->seen.newest(), answer);
    arm->seen.note(pose->sequence);
  });
}

inkwell_result inkwell_sleep(inkwell_arm* arm, double duration_s) {
  return guarded([&] { arm_of(arm).sleep(duration_s); });
}

inkwell_result inkwell_is_referenced(inkwell_arm* arm, int* is_referenced) {
  return guarded([&] {
    required(is_referenced, "The pointer to the result");
    return arm_of(arm).read([&](const PoseFeed::Seen& last) { *is_referenced = last.is_referenced ? 1 : 0; }, refuse);
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

const char* inkwell_fault_name(int fault) {
  for (const auto& row : protocol::fault_table)
    if (row.code == fault) return row.name.data();  // a string literal, so it is zero-terminated
  return nullptr;
}

const char* inkwell_fault_text(int fault) {
  thread_local char text[sentence_maximum];  // a plain array, as in inkwell_error_text()
  text[0] = '\0';
  guarded([&] {
    const bool known = fault >= 0 && fault <= 0xFFFF;
    copy_text(device::fault_line(static_cast<protocol::Fault>(known ? fault : 0xFFFF)), text);
  });
  return text;
}

// ---- force -------------------------------------------------------------------------------------------------

inkwell_result inkwell_enable_force(inkwell_arm* arm, double timeout_s) {
  return guarded([&] { arm_of(arm).enable_force(timeout_s); });
}

inkwell_result inkwell_disable_force(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).disable_force(); });
}

inkwell_result inkwell_stop(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).stop(); });
}

inkwell_result inkwell_take_over(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).take_over(); });
}

inkwell_result inkwell_get_driver(inkwell_arm* arm, inkwell_driver* driver) {
  return guarded([&] {
    *required(driver, "The pointer to the result") = {};
    const auto found = arm_of(arm).device().driver();
    if (!found) return;
    driver->is_driven = 1;
    driver->is_this_arm = found->is_this_device ? 1 : 0;
    driver->process_id = found->process_id;
    driver->driven_s = found->driven_s;
    copy_text(found->program, driver->program);
  });
}

inkwell_result inkwell_clear_fault(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).clear_fault(); });
}

inkwell_result inkwell_set_force_mode(inkwell_arm* arm, inkwell_force_mode mode) {
  return guarded([&] {
    if (mode != INKWELL_BESIDE_WALLS && mode != INKWELL_INSTEAD_OF_WALLS)
      throw BadArgument(fmt::format("{} is not a force mode. Give INKWELL_BESIDE_WALLS or INKWELL_INSTEAD_OF_WALLS.",
                                    static_cast<int>(mode)));
    arm_of(arm).set_force_mode(static_cast<protocol::ForceMode>(mode));
  });
}

inkwell_result inkwell_set_force(inkwell_arm* arm, const double force_N[3]) {
  return guarded([&] {
    required(force_N, "The force");
    const auto result = arm_of(arm).set_force({force_N[0], force_N[1], force_N[2]}, refuse);
    if (result == INKWELL_OK) arm->seen.note_force();
    return result;
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
  return guarded([&] { arm_of(arm).servo().stop(); });
}

int inkwell_servo_is_running(inkwell_arm* arm) {
  bool runs = false;
  guarded([&] { runs = arm_of(arm).servo().is_running(); });
  return runs ? 1 : 0;
}

inkwell_result inkwell_servo_result(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).servo().throw_what_ended_it(); });
}

// ---- virtual hand ------------------------------------------------------------------------------------------

inkwell_result inkwell_move_virtual_hand(inkwell_arm* arm, const double target_m[3], double stiffness_N_per_m) {
  return guarded([&] {
    required(target_m, "The target");
    const device::Vector3 target{target_m[0], target_m[1], target_m[2]};
    arm_of(arm).with_own_board([&](device::ControlClient& board) {
      board.hand({.holds = true,
                  .target_m = target,
                  .stiffness_N_per_m = stiffness_N_per_m,
                  .damping_Ns_per_m = 0.01 * stiffness_N_per_m});
      board.dock(false);
    });
  });
}

inkwell_result inkwell_release_virtual_hand(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).with_own_board([](device::ControlClient& board) { board.hand({}); }); });
}

inkwell_result inkwell_press_virtual_buttons(inkwell_arm* arm, int button_1, int button_2) {
  return guarded([&] {
    arm_of(arm).with_own_board([&](device::ControlClient& board) { board.buttons(button_1 != 0, button_2 != 0); });
  });
}
