// How `--help` looks: what a newcomer needs, in the words of the options and commands themselves.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// For the program and the commands that are added to it afterwards.
void set_help_style(CLI::App& program);

/// What stands below a command's options: examples, one a line, and what all commands have in common.
void add_examples(CLI::App& command, const std::string& examples);

/// Checks of a number that name the range as a person would.
CLI::Validator zero_or_more();
CLI::Validator more_than_zero();
CLI::Validator number_within(double low, double high);
CLI::Validator whole_number_within(int low, int high);

/// An empty text where a device or a file is named is a variable of a script that was not set: it must not become the
/// device that is there without the option.
CLI::Validator not_empty();

/// Says which commands there are, and which was probably meant, if a word stands where only a command may, or if the
/// command that was given needs one of its own and has none.
std::optional<std::string> wrong_command(const CLI::App& program);

}  // namespace inkwell::command_line
