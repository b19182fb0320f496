// Converts CLI11 error messages to sentences.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace inkwell::command_line {

/// The returned sentence names the wrong value, its option and the expected value.
std::string sentence_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace inkwell::command_line
