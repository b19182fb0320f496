// What CLI11 says of a value in raw words, as a sentence.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// Names the value, the option or argument that it was for, and what to give instead.
std::string sentence_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace inkwell::command_line
