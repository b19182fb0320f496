#include "host/companion/command_line/progress_bar.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

constexpr int width = 24;

bool is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace

void ProgressBar::operator()(std::string_view step, std::optional<double> done) {
  const int filled = static_cast<int>(done.value_or(0) * width + 0.5);
  const std::string bar = done ? fmt::format("[{:#>{}}{:.>{}}] ", "", filled, "", width - filled) : std::string();
  if (is_terminal()) {
    local::print_error("\r\x1b[K{}{}", bar, step);
    is_open_ = true;
    if (done && *done >= 1.0) end();
  } else if (const auto sentence = step.substr(0, step.find(':')); sentence != last_step_) {
    last_step_ = sentence;
    if (done)
      local::print_error("{:3.0f} %  {}\n", 100 * *done, step);
    else
      local::print_error("{}\n", step);
  }
}

void ProgressBar::end() {
  if (is_open_) local::print_error("\n");
  is_open_ = false;
}

}  // namespace inkwell::command_line
