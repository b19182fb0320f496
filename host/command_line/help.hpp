// How `--help` looks: what a newcomer needs, in the words of the options and commands themselves.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// For the program and the commands that are added to it afterwards.
void set_help_style(CLI::App& program);

/// What stands below a command's options: examples, one a line, and what all commands have in common.
void add_examples(CLI::App& command, const std::string& examples);

}  // namespace inkwell::command_line
