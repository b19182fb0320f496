// A recording read back from a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <recording/information.hpp>

namespace inkwell::recording {

struct Mark {
  std::uint32_t period;  ///< control period at which it was set
  std::string text;
};

struct Recording {
  Information information;
  bool complete = true;                     ///< false: the program or the disk gave up before the end was written
  std::vector<std::uint32_t> periods;       ///< control period of each sample
  std::vector<std::vector<float>> columns;  ///< one for each of information.signals, as long as `periods`
  std::vector<Mark> marks;
  std::vector<std::string> remarks;         ///< sentences about what this version did not understand

  std::size_t size() const { return periods.size(); }
  double time_s(std::size_t sample) const { return static_cast<double>(periods[sample]) / protocol::servo_rate_Hz; }
  /// Control periods between the first and the last sample that are missing.
  std::uint64_t lost() const;
};

/// Reads an HDF5 or CSV recording, told apart by their content. A file whose end is missing is read as far as
/// it goes. Throws device::Error with a sentence if it is missing, damaged or no recording.
Recording read(const std::filesystem::path& file);

}  // namespace inkwell::recording
