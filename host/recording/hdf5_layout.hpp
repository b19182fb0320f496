// How a recording lies in an HDF5 file; columns are compressed (shuffle and deflate, which every HDF5 has):
//
//   /                    attributes: format, format_version, created_utc, firmware_version, protocol_version,
//                        serial_number, arm, force_law (as the device sent it, in hexadecimal digits), simulation,
//                        servo_rate_Hz, step_periods (control periods from one sample to the next)
//   /parameters/NAME     scalar float, attributes unit and help
//   /period              int64[N], control period of each sample (uint32, which wraps, in files of earlier versions)
//   /time_s              float64[N]
//   /signals/NAME        float32[N], attributes unit and help
//   /simulated/NAME      float32[N], attributes unit and help: what a simulation knew beside the signals, if it did
//   /marks/period        int64[M] (likewise)
//   /marks/text          text[M] of fixed length, the bytes of UTF-8
//                        (called UTF-8, and shorter, in files of earlier versions)
//   /marks/kind          text[M]: mark of the user, connection, force, fault, parameter, loss
//   /marks/clock_utc     text[M]: of the computer, ISO 8601 with milliseconds
//                        (these two are not in files of earlier versions)
//   /samples             uint64, how many samples are whole on the disk; a column may be longer after a crash
//   /complete            int32, 1 once the end was written
#pragma once

#include <cstddef>

namespace inkwell::recording {

inline constexpr std::size_t mark_text_bytes = 240;
inline constexpr std::size_t mark_kind_bytes = 16;
inline constexpr std::size_t mark_clock_bytes = 24;

}  // namespace inkwell::recording
