// A recording that a command was given.
#pragma once

#include <string>

#include <recording/recording.hpp>

namespace inkwell::command_line {

/// Says on standard error what was not understood of it. Throws device::Error if it cannot be read.
recording::Recording read_recording(const std::string& file);

}  // namespace inkwell::command_line
