// Subcommands of `inkwell parameters` for the stored parameters.
#pragma once

#include "commands.hpp"

namespace inkwell::command_line {

/// A virtual board that was started for one command exits with it. Reports this, and the option that retains the
/// values, if they would be lost.
void tell_what_ends(const DeviceOptions& options, bool is_stored);

void add_store_commands(CLI::App& parameters, const Place& place);

}  // namespace inkwell::command_line
