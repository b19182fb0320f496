// The commands of the `inkwell` program. Each adds itself to the program's options and, if it was chosen, runs.
#pragma once

// To add a command:
// 1. Add a line to INKWELL_COMMANDS.
// 2. Define add_NAME_command() in NAME_command.cpp in this folder. Its help needs examples with units.
// 3. Add the command and its subcommands to the list in tests/system/bad_input_test.cpp.
//
// Manual pages, completion and the page of commands are generated from the help texts.

#include <functional>

#include <window/window_options.hpp>

#include "connection.hpp"

namespace inkwell::command_line {

/// What is to be done once the options are read; returns the exit code.
using Action = std::function<int()>;
/// Opens the window, on a recording unless its name is empty; returns the exit code.
using OpenWindow = std::function<int(const window::ReplayRequest& replay)>;

/// Where a command adds itself, and what it may use when it runs.
struct Place {
  CLI::App& program;
  const DeviceOptions& device;
  Action& action;  ///< to be set when the command is chosen
  OpenWindow open_window;
};

/// In the order of the program's help.
#define INKWELL_COMMANDS(X) \
  X(info)                   \
  X(devices)                \
  X(fault)                  \
  X(self_test)              \
  X(force)                  \
  X(watch)                  \
  X(parameters)             \
  X(signals)                \
  X(reference)              \
  X(experiment)             \
  X(campaign)               \
  X(soak)                   \
  X(calibrate)              \
  X(tune)                   \
  X(check)                  \
  X(measure)                \
  X(record)                 \
  X(replay)                 \
  X(plot)                   \
  X(run)                    \
  X(flash)

#define X(name) void add_##name##_command(const Place& place);
INKWELL_COMMANDS(X)
#undef X

/// Without a command the window opens. Returns what opens it for a command, with the same options.
OpenWindow add_window_options(CLI::App& program, const DeviceOptions& options, Action& action);

/// Throws UsageError if the command that was chosen opens no window and an option of the window was given: nobody would
/// look at it, a mistake in it neither.
void refuse_window_options_in_vain(const CLI::App& program);

}  // namespace inkwell::command_line
