#include "host/companion/command_line/mark_keys.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>

#include <fmt/format.h>

#include "host/client/local/interruption.hpp"

namespace inkwell::command_line {

MarkKeys::MarkKeys(int descriptor) : descriptor_(descriptor) {
  termios terminal;
  if (tcgetattr(descriptor_, &terminal) != 0) return;
  terminal_before_ = terminal;
  // Disables line buffering and echo of the terminal. Ctrl-C still interrupts.
  terminal.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(descriptor_, TCSANOW, &terminal);
}

MarkKeys::~MarkKeys() {
  if (terminal_before_) tcsetattr(descriptor_, TCSANOW, &*terminal_before_);
}

void MarkKeys::read_what_is_there() {
  pollfd waiting{descriptor_, POLLIN, 0};
  std::array<char, 256> chunk;
  while (!is_at_end_ && local::repeat_interrupted([&] { return poll(&waiting, 1, 0); }) == 1) {
    const ssize_t length = local::repeat_interrupted([&] { return read(descriptor_, chunk.data(), chunk.size()); });
    if (length <= 0)
      is_at_end_ = true;
    else
      pending_.append(chunk.data(), static_cast<std::size_t>(length));
  }
}

std::optional<std::string> MarkKeys::next() {
  read_what_is_there();
  const auto end = pending_.find_first_of(terminal_before_ ? " \n" : "\n");
  if (end == std::string::npos) return std::nullopt;
  std::string line = pending_.substr(0, end);
  pending_.erase(0, end + 1);
  ++count_;
  return terminal_before_ || line.empty() ? fmt::format("mark {}", count_) : line;
}

}  // namespace inkwell::command_line
