// Subcommands of `inkwell parameters` for the stored parameters.
#pragma once

#include "host/companion/command_line/commands.hpp"

namespace inkwell::command_line {

/// Prints a warning if values are lost when the virtual board exits. The warning names the option that retains the
/// values.
void print_unstored(const DeviceOptions& options, bool is_stored);

void add_store_commands(CLI::App& parameters, const Place& place);

}  // namespace inkwell::command_line
