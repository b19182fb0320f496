// Formats the output of `--help`.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// Sets the help style of the program and of all commands that are added afterwards.
void set_help_style(CLI::App& program);

/// Adds the examples, one per line, and the hints of `inkwell` about its common options after a command's options.
void add_examples(CLI::App& command, const std::string& examples);
/// The same with the hints of another program.
void add_examples(CLI::App& command, const std::string& examples, const std::string& hints);

/// Validators for numbers. The error messages state the range.
CLI::Validator zero_or_more();
CLI::Validator more_than_zero();
CLI::Validator number_within(double low, double high);
CLI::Validator whole_number_within(int low, int high);

/// Rejects an empty device or file name. An empty name probably comes from an unset script variable and must not select
/// the default device.
CLI::Validator not_empty();

/// Returns an error sentence if an unknown command was given or a required subcommand is missing. The sentence lists
/// the commands and suggests the most similar command.
std::optional<std::string> wrong_command(const CLI::App& program);

}  // namespace inkwell::command_line
