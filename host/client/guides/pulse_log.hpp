// Saves the test pulses of a guide in one recording, so that users can identify motors themselves.
#pragma once

#include <filesystem>
#include <string>

#include "host/client/guides/device_port.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::guides {

/// The pulses follow each other. 10 ms without values separate them, because a user may wait between two pulses.
class PulseLog {
 public:
  /// Without a file, nothing is saved.
  explicit PulseLog(std::filesystem::path file) : file_(std::move(file)) {}

  /// Appends a pulse with a mark and saves all pulses. Signals that the pulse did not record have no values. Throws
  /// device::Error if the file cannot be written.
  void add(const Observation& now, const recording::Recording& pulse, const std::string& mark);

 private:
  std::filesystem::path file_;
  recording::Recording all_;
};

}  // namespace inkwell::guides
