// Parses a command line, runs the chosen command, and reports errors.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// The action of the chosen command; returns the exit code.
using Action = std::function<int()>;

/// Parses the arguments of main() and runs the action that the chosen command has set. `check` is called after parsing
/// and may throw UsageError. Prints errors to standard error, with the program name. Returns the exit code: 0 success,
/// 1 failure, 2 wrong usage.
int run_program(CLI::App& program, int argument_count, char** arguments, const Action& action,
                const std::function<void()>& check = {});

}  // namespace inkwell::command_line
