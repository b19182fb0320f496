// Standard output and standard error of a program.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace inkwell::local {

/// Standard output was not written completely. `what()` is a sentence.
class LostOutput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes the buffered standard output, so that a reader follows a running command. @throws LostOutput.
void flush_output();

/// Writes the buffered standard output. Returns true if any output since the start of the program was lost.
bool is_output_lost();

/// Every program calls this function at its end. Returns `exit_code`. If output was lost, prints a sentence to standard
/// error, and returns 1 instead of 0.
int checked_exit_code(std::string_view program, int exit_code);

/// Prints to standard error. A closed terminal must not interrupt an orderly exit, so this function does not throw if
/// the text cannot be written.
void print_error(std::string_view text);

template <class... Values>
void print_error(fmt::format_string<Values...> format, Values&&... values) requires(sizeof...(Values) > 0) {
  print_error(fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace inkwell::local
