// The commands of the `inkwell` program. Each command registers its options and an action.
#pragma once

// To add a command:
// (1) Add a line to INKWELL_COMMANDS.
// (2) Define add_NAME_command() in NAME_command.cpp in this folder. The help text needs examples with units.
// (3) Add the command and its subcommands to the list in tests/system/bad_input_test.cpp.
//
// Manual pages, completion and the command page are generated from the help texts.

#include <functional>

#include "host/client/command_line/connection.hpp"
#include "host/client/command_line/run_program.hpp"
#include "host/companion/window/window_options.hpp"

namespace inkwell::command_line {

/// Opens the window and returns the exit code. `adapt` changes the options of the command line.
using OpenWindow = std::function<int(const std::function<void(window::WindowOptions&)>& adapt)>;

/// Arguments of the add_NAME_command() functions.
struct CommandContext {
  CLI::App& program;
  const DeviceOptions& device;
  Action& action;  ///< set when the command is chosen
  OpenWindow open_window;
};

/// The commands, in the order of the program's help.
#define INKWELL_COMMANDS(X) \
  X(info)                   \
  X(devices)                \
  X(arms)                   \
  X(fault)                  \
  X(self_test)              \
  X(force)                  \
  X(watch)                  \
  X(parameters)             \
  X(signals)                \
  X(reference)              \
  X(experiment)             \
  X(calibrate)              \
  X(tune)                   \
  X(check)                  \
  X(measure)                \
  X(record)                 \
  X(replay)                 \
  X(plot)                   \
  X(mesh)                   \
  X(feel)                   \
  X(run)                    \
  X(flash)

#define X(name) void add_##name##_command(const CommandContext& context);
INKWELL_COMMANDS(X)
#undef X

/// Adds the moved commands, which only report their new names.
void add_moved_commands(CLI::App& program);

/// Adds the window options. Returns a function that opens the window.
OpenWindow add_window_options(CLI::App& program, const DeviceOptions& options, Action& action);

/// Throws UsageError if the user combines a window option with a command that opens no window.
void refuse_window_options_in_vain(const CLI::App& program);

}  // namespace inkwell::command_line
