// Layout of a recording in an HDF5 file. Columns are compressed with shuffle and deflate, which every HDF5 build has.
//
//   `/`                    attributes: format, format_version, name, note, created_utc, library_version,
//                          library_sha256, image_sha256, arm_sha256, image_check, firmware_version, protocol_version,
//                          serial_number, arm, force_law (as sent by the device, in hexadecimal digits), simulation,
//                          servo_rate_Hz, step_periods (control periods from one sample to the next).
//   `/parameters/NAME`     scalar float, attributes unit and help.
//   `/period`              int64[N], control period of each sample.
//   `/time_s`              float64[N].
//   `/signals/NAME`        float32[N], attributes unit and help.
//   `/simulated/NAME`      float32[N], attributes unit and help: quantities of a simulation, if available.
//   `/marks/period`        int64[M], control period of each mark.
//   `/marks/text`          text[M], UTF-8 with a fixed length in bytes.
//   `/marks/kind`          text[M]: mark of the user, connection, force, fault, parameter, loss, button, source, shape.
//   `/marks/clock_utc`     text[M]: time of the computer, ISO 8601 with microseconds.
//   `/clock/period`        int64[C], control period of a sample, about once per second.
//   `/clock/utc_us`        int64[C], time of the computer when this sample arrived, microseconds since 1970.
//   `/overview/signals/NAME`, `/overview/simulated/NAME`
//                          float32[3 B], minimum, maximum and mean of each block of 256 samples. Samples after the
//                          last block have no overview. The overview replaces the samples in plots of a long time.
//   `/overview/blocks`     uint64, number of blocks that are completely on disk.
//   `/samples`             uint64, number of samples that are completely on disk; a column may be longer after a crash.
//   `/complete`            int32, 1 once the recording has ended and nothing is missing.
//
// In files of earlier versions, control periods are uint32 values that wrap. These files contain no `/marks/kind`, no
// `/marks/clock_utc`, no `/clock` and no `/overview`, and fewer attributes. A black box has no `/overview`.
#pragma once

#include <cstddef>

namespace inkwell::recording {

inline constexpr std::size_t mark_text_bytes = 240;
inline constexpr std::size_t mark_kind_bytes = 16;
inline constexpr std::size_t mark_clock_bytes = 32;

}  // namespace inkwell::recording
