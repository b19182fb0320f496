// The commands of the `inkwell-lab` program. Each command registers its options and an action.
#pragma once

// To add a command:
// (1) Add a line to INKWELL_LAB_COMMANDS.
// (2) Define add_NAME_command() in NAME_command.cpp in this folder. The help text needs examples with units.
// (3) Add the command and its subcommands to the list in tests/system/bad_input_test.cpp.
//
// Manual pages, completion and the command page are generated from the help texts.

#include <string>

#include "host/client/command_line/connection.hpp"
#include "host/client/command_line/run_program.hpp"

namespace inkwell::lab {

/// Arguments of the functions that add commands.
struct CommandContext {
  CLI::App& program;
  const command_line::DeviceOptions& device;
  command_line::Action& action;  ///< set when the command is chosen
};

/// The commands, in the order of the program's help.
#define INKWELL_LAB_COMMANDS(X) \
  X(campaign)                   \
  X(soak)

#define X(name) void add_##name##_command(const CommandContext& context);
INKWELL_LAB_COMMANDS(X)
#undef X

/// Adds the examples and the option hints to the help text.
void add_lab_examples(CLI::App& command, const std::string& examples);

}  // namespace inkwell::lab
