// Functions of the C interface for complete states, abilities, joint torques, claims, time limits and real time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <thread>

#include "host/bindings/library/abilities.hpp"
#include "host/bindings/library/address.hpp"
#include "host/bindings/library/c_guard.hpp"
#include "host/bindings/library/growing_struct.hpp"

using namespace inkwell::library;
namespace control = inkwell::control;

namespace {

#define TEXT_OF_NUMBER(number) #number
#define TEXT_OF(macro) TEXT_OF_NUMBER(macro)
static_assert(std::string_view(INKWELL_VERSION) ==
                  TEXT_OF(INKWELL_VERSION_MAJOR) "." TEXT_OF(INKWELL_VERSION_MINOR) "." TEXT_OF(INKWELL_VERSION_PATCH),
              "Write the version of CMakeLists.txt into inkwell.h");

// Programs contain these layouts. New members are appended.
static_assert(offsetof(inkwell_arm_state, quaternion) == 264 && offsetof(inkwell_arm_state, joint_torque_Nm) == 344);
static_assert(offsetof(inkwell_abilities, force_N) == 160 && offsetof(inkwell_abilities, pose_rate_Hz) == 240);

constexpr auto device_search_interval = std::chrono::milliseconds(250);

control::Triple joints_of(const double (&joint_rad)[3]) {
  control::Triple joints{};
  for (std::size_t i = 0; i < 3; ++i) joints[i] = static_cast<float>(joint_rad[i]);
  return joints;
}

void require_finite(const double* values, const char* what) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!std::isfinite(values[i]))
      throw BadArgument(fmt::format("{} is not a finite number. Give finite numbers.", what));
}

inkwell_result refuse_singularity() {
  return refuse(INKWELL_REFUSED,
                "No force has these joint torques, because the arm is stretched or folded. Move the stylus.");
}

bool is_same(const inkwell_device& one, const inkwell_device& other) {
  return std::strcmp(one.address, other.address) == 0 && std::strcmp(one.serial_number, other.serial_number) == 0 &&
         std::strcmp(one.product, other.product) == 0 && one.is_virtual == other.is_virtual;
}

}  // namespace

// ---- devices -----------------------------------------------------------------------------------------------

inkwell_result inkwell_open_with_timeout(const char* address, double timeout_s, inkwell_arm** arm) {
  return guarded([&] {
    const inkwell::process::NoCancellationPoints whole;
    *required(arm, "The pointer to the arm") = new inkwell_arm(address == nullptr ? "" : address, timeout_s);
  });
}

inkwell_result inkwell_wait_for_devices(double timeout_s, inkwell_device* devices, size_t capacity, size_t* count) {
  return guarded([&] {
    required(count, "The count");
    if (capacity > 0) required(devices, "The list of devices");
    const std::size_t known = std::min(capacity, *count);
    double left_s = checked_timeout_s(timeout_s);
    for (;;) {
      const auto found = list_devices();
      if (found.size() != *count || !std::equal(devices, devices + known, found.begin(), is_same)) {
        *count = found.size();
        std::copy_n(found.begin(), std::min(capacity, found.size()), devices);
        return;
      }
      if (left_s <= 0) throw TimedOut("The list of arms has not changed. Plug an arm in, or wait longer.");
      const std::chrono::duration<double> wait =
          std::min(std::chrono::duration<double>(device_search_interval), std::chrono::duration<double>(left_s));
      left_s -= wait.count();
      const inkwell::process::CancellationPoint point;
      std::this_thread::sleep_for(wait);
    }
  });
}

// ---- state -------------------------------------------------------------------------------------------------

inkwell_result inkwell_get_state(inkwell_arm* arm, inkwell_arm_state* state, size_t size) {
  return guarded([&] {
    required(state, "The pointer to the state");
    constexpr std::size_t first_size =
        offsetof(inkwell_arm_state, joint_torque_Nm) + sizeof(inkwell_arm_state{}.joint_torque_Nm);
    check_size(size, first_size, "inkwell_arm_state");
    inkwell_arm_state whole{};
    const auto take = [&](const PoseFeed::Seen& last) {
      const Motion& motion = last.motion;
      whole.pose = last.pose;
      whole.is_referenced = last.is_referenced ? 1 : 0;
      whole.received_ns = motion.received_ns;
      whole.received_monotonic_ns = motion.received_monotonic_ns;
      std::ranges::copy(motion.quaternion, whole.quaternion);
      std::ranges::copy(motion.angular_velocity_rad_per_s, whole.angular_velocity_rad_per_s);
      std::ranges::copy(motion.joint_speed_rad_per_s, whole.joint_speed_rad_per_s);
      std::ranges::copy(motion.joint_torque_Nm, whole.joint_torque_Nm);
    };
    const auto result = arm_of(arm).read(take, refuse);
    copy_members(whole, state, size);
    return result;
  });
}

inkwell_result inkwell_get_abilities(inkwell_arm* arm, inkwell_abilities* abilities, size_t size) {
  return guarded([&] {
    required(abilities, "The pointer to the abilities");
    constexpr std::size_t first_size = offsetof(inkwell_abilities, pose_rate_Hz) + sizeof(double);
    check_size(size, first_size, "inkwell_abilities");
    Arm& opened = arm_of(arm);
    copy_members(abilities_of(opened.device().parameters(), opened.geometry()), abilities, size);
  });
}

// ---- joint torques -----------------------------------------------------------------------------------------

inkwell_result inkwell_force_of_torques(inkwell_arm* arm, const double joint_rad[3], const double torque_Nm[3],
                                        double force_N[3]) {
  return guarded([&] {
    std::fill_n(required(force_N, "The pointer to the force"), 3, 0.0);
    require_finite(required(joint_rad, "The list of joint angles"), "A joint angle");
    require_finite(required(torque_Nm, "The list of torques"), "A torque");
    const auto joints = joints_of({joint_rad[0], joint_rad[1], joint_rad[2]});
    const auto force =
        force_of_torques(arm_of(arm).forward_kinematics(joints).jacobian, {torque_Nm[0], torque_Nm[1], torque_Nm[2]});
    if (!force) return refuse_singularity();
    std::ranges::copy(*force, force_N);
    return INKWELL_OK;
  });
}

inkwell_result inkwell_set_joint_torques(inkwell_arm* arm, const double torque_Nm[3]) {
  return guarded([&] {
    require_finite(required(torque_Nm, "The list of torques"), "A torque");
    control::Triple joints{};
    bool is_referenced = false;
    const auto take = [&](const PoseFeed::Seen& last) {
      joints = joints_of(last.pose.joint_rad);
      is_referenced = last.is_referenced;
    };
    if (const auto result = arm_of(arm).read(take, refuse); result != INKWELL_OK) return result;
    if (!is_referenced)
      return refuse(INKWELL_REFUSED, "The encoders are not referenced. Put the stylus into the inkwell once.");
    const auto force =
        force_of_torques(arm->arm.forward_kinematics(joints).jacobian, {torque_Nm[0], torque_Nm[1], torque_Nm[2]});
    const auto force_N = force.value_or(std::array<double, 3>{});
    const auto result = arm->arm.set_force({force_N[0], force_N[1], force_N[2]}, refuse);
    if (result != INKWELL_OK) return result;
    arm->seen.note_force();
    return force ? INKWELL_OK : refuse_singularity();
  });
}

// ---- claim, real time --------------------------------------------------------------------------------------

inkwell_result inkwell_claim(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).claim(); });
}

inkwell_result inkwell_release(inkwell_arm* arm) {
  return guarded([&] { arm_of(arm).release(); });
}

inkwell_result inkwell_set_thread_priority(inkwell_arm* arm, int priority) {
  return guarded([&] { arm_of(arm).set_thread_priority(priority); });
}
