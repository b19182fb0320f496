// Types and values of the HDAPI binary interface. Programs include the original HDAPI headers instead of this header.
#pragma once

#include <cstdint>

namespace inkwell::dropins {

using Enum = unsigned int;
using Handle = unsigned int;
using Boolean = unsigned char;
using TaskHandle = unsigned long;
using Callback = unsigned int (*)(void* user);

inline constexpr Handle invalid_handle = 0xFFFFFFFF;

enum CallbackAnswer : unsigned { callback_done = 0, callback_continue = 1 };
enum WaitCode : unsigned { wait_check_status = 0, wait_infinite = 1 };

enum ErrorCode : unsigned {
  success = 0,
  invalid_enum = 0x100,
  invalid_value = 0x101,
  invalid_operation = 0x102,
  invalid_input_type = 0x103,
  bad_handle = 0x104,
  warm_motors = 0x200,
  exceeded_max_force = 0x201,
  exceeded_max_force_impulse = 0x202,
  exceeded_max_velocity = 0x203,
  force_error = 0x204,
  device_fault = 0x300,
  device_already_initiated = 0x301,
  comm_error = 0x302,
  comm_config_error = 0x303,
  timer_error = 0x304,
  illegal_begin = 0x400,
  illegal_end = 0x401,
  frame_error = 0x402,
  invalid_priority = 0x500,
  scheduler_full = 0x501,
  invalid_license = 0x600,
};

/// The return value of hdGetError().
struct ErrorInfo {
  unsigned code;
  int internal_code;
  Handle device;
};
static_assert(sizeof(ErrorInfo) == 12);

enum Calibration : unsigned { calibration_ok = 0x5000, calibration_needs_update, calibration_needs_manual_input };
inline constexpr unsigned calibration_style_inkwell = 4;

}  // namespace inkwell::dropins
