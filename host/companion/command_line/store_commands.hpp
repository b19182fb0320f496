// Subcommands of `inkwell parameters` for the stored parameters.
#pragma once

#include <string_view>

#include "host/companion/command_line/commands.hpp"

namespace inkwell::command_line {

/// Prints the consequence of an action to standard error. Returns true if the user agrees in the terminal.
/// @throws UsageError without a terminal.
bool agrees(std::string_view consequence, std::string_view action);

/// Prints a warning if the virtual board will discard the values at its exit. The warning names the option that
/// prevents this loss.
void print_unstored(const DeviceOptions& options, bool is_stored);

void add_store_commands(CLI::App& parameters, const CommandContext& context);

}  // namespace inkwell::command_line
