// Commands below `inkwell parameters` for what the board keeps of them over its power.
#pragma once

#include "commands.hpp"

namespace inkwell::command_line {

/// A virtual board that was started for one command ends with it. Says so, and what would have kept the values, if
/// nothing does.
void tell_what_ends(const DeviceOptions& options, bool is_stored);

void add_store_commands(CLI::App& parameters, const Place& place);

}  // namespace inkwell::command_line
