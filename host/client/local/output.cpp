#include "host/client/local/output.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace inkwell::local {
namespace {

/// Returns an empty text if all output was written.
std::string lost_output_message() {
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  const int reason = errno;
  if (std::cout && std::ferror(stdout) == 0) return {};
  return fmt::format("Standard output cannot be written{}. Check the free space, or the program that reads the output.",
                     reason == 0 ? "" : fmt::format(" ({})", std::strerror(reason)));
}

}  // namespace

void flush_output() {
  if (const std::string message = lost_output_message(); !message.empty()) throw LostOutput(message);
}

bool is_output_lost() { return !lost_output_message().empty(); }

int checked_exit_code(std::string_view program, int exit_code) {
  const std::string message = lost_output_message();
  if (message.empty()) return exit_code;
  print_error("{}: {}\n", program, message);
  return exit_code == 0 ? 1 : exit_code;
}

void print_error(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace inkwell::local
