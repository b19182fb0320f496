// Reads a recording for a command.
#pragma once

#include <string>

#include "host/client/recording/recording.hpp"

namespace inkwell::command_line {

/// Reports unknown parts of the recording on standard error. Throws device::Error if the file cannot be read.
recording::Recording read_recording(const std::string& file);

}  // namespace inkwell::command_line
