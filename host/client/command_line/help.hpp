// Formats the output of `--help`.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

void set_help_style(CLI::App& program);

/// Adds examples and the common hints of `inkwell` to the help text of a command.
void add_examples(CLI::App& command, const std::string& examples);
/// Adds examples and the given hints to the help text of a command.
void add_examples(CLI::App& command, const std::string& examples, const std::string& hints);

/// The error messages of these number validators state the range.
CLI::Validator zero_or_more();
CLI::Validator more_than_zero();
CLI::Validator number_within(double low, double high);
CLI::Validator whole_number_within(int low, int high);

/// Rejects an empty device name or file name. An unset script variable must not select the default device.
CLI::Validator not_empty();

/// Returns an error sentence if a command is unknown or a required subcommand is missing. The sentence lists the valid
/// commands and suggests the most similar command.
std::optional<std::string> wrong_command(const CLI::App& program);

}  // namespace inkwell::command_line
