// Opens a recording for a command.
#pragma once

#include <string>

#include "host/client/recording/stored_recording.hpp"

namespace inkwell::command_line {

/// Reports unknown parts of the recording on standard error. Throws device::Error if the file cannot be read.
recording::StoredRecording open_recording(const std::string& file);

}  // namespace inkwell::command_line
