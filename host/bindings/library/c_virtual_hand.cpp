// Functions of the C interface for the simulated hand of any virtual board.
#include <algorithm>
#include <string>
#include <vector>

#include "host/bindings/library/c_guard.hpp"

using namespace inkwell::library;
namespace device = inkwell::device;

inkwell_result inkwell_connect_virtual_hand(inkwell_arm* arm, const char* control) {
  return guarded([&] { arm_of(arm).connect_control(required(control, "The address of the control socket")); });
}

inkwell_result inkwell_hold_virtual_hand(inkwell_arm* arm, const double target_m[3], double stiffness_N_per_m,
                                         double damping_Ns_per_m) {
  return guarded([&] {
    required(target_m, "The target");
    const device::Hand hand{.holds = true,
                            .target_m = {target_m[0], target_m[1], target_m[2]},
                            .stiffness_N_per_m = stiffness_N_per_m,
                            .damping_Ns_per_m = damping_Ns_per_m};
    arm_of(arm).with_own_board([&](device::ControlClient& board) {
      board.hand(hand);
      board.dock(false);
    });
  });
}

inkwell_result inkwell_move_virtual_hand_along(inkwell_arm* arm, const inkwell_waypoint* path, size_t count) {
  return guarded([&] {
    if (count > 0) required(path, "The path");
    std::vector<device::HandWaypoint> points;
    for (size_t i = 0; i < count; ++i)
      points.push_back({path[i].after_s, {path[i].target_m[0], path[i].target_m[1], path[i].target_m[2]}});
    arm_of(arm).with_own_board([&](device::ControlClient& board) { board.hand_path(points); });
  });
}

inkwell_result inkwell_read_virtual_truth(inkwell_arm* arm, char* json, size_t capacity, size_t* size) {
  return guarded([&] {
    if (capacity > 0) required(json, "The pointer to the text");
    std::string text;
    arm_of(arm).with_own_board([&](device::ControlClient& board) { text = board.truth().dump(); });
    if (size != nullptr) *size = text.size() + 1;
    if (capacity == 0) return;
    const size_t written = text.copy(json, capacity - 1);
    json[written] = '\0';
  });
}
