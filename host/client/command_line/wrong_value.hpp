// Converts CLI11's messages about values to sentences.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// The sentence names the value, its option or argument, and the expected value.
std::string sentence_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace inkwell::command_line
