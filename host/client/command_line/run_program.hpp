// Parses a command line, runs the chosen command, and reports errors.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

using Action = std::function<int()>;

/// Parses the arguments of main(), runs `action`, and prints errors to standard error. `check` is called after parsing
/// and may throw UsageError. Returns exit code 0 for success, 1 for failure or lost output,
/// and 2 for wrong usage.
int run_program(CLI::App& program, int argument_count, char** arguments, const Action& action,
                const std::function<void()>& check = {});

}  // namespace inkwell::command_line
