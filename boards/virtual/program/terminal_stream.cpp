#include "boards/virtual/program/terminal_stream.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "host/client/local/interruption.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr int poll_interval_ms = 10;  // polling interval for space in the output

}  // namespace

TerminalStream::TerminalStream(std::function<void()> on_arrival)
    : on_arrival_(std::move(on_arrival)), input_(STDIN_FILENO), output_(STDOUT_FILENO) {
  start();
}

TerminalStream::TerminalStream(const std::filesystem::path& path, std::function<void()> on_arrival)
    : on_arrival_(std::move(on_arrival)), link_(path) {
  input_ = output_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  std::array<char, 64> name{};
  if (input_ < 0 || ::grantpt(input_) != 0 || ::unlockpt(input_) != 0 ||
      ::ptsname_r(input_, name.data(), name.size()) != 0)
    throw std::runtime_error(fmt::format("--uart: a pseudo-terminal cannot be created: {}.", std::strerror(errno)));
  // The open terminal side makes writes succeed while no other program uses the terminal.
  other_side_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios raw{};
  ::tcgetattr(other_side_, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(other_side_, TCSANOW, &raw);
  std::error_code error;
  std::filesystem::create_symlink(name.data(), link_, error);
  if (error) {
    ::close(other_side_);
    ::close(input_);
    throw std::runtime_error(
        fmt::format("{} cannot be created as a link to a terminal: {}. Use another path for --uart.", path.string(),
                    error.message()));
  }
  start();
}

void TerminalStream::start() {
  ending_ = ::eventfd(0, EFD_CLOEXEC);
  thread_ = std::thread([this] { read(); });
}

TerminalStream::~TerminalStream() {
  const std::uint64_t one = 1;
  local::repeat_interrupted([&] { return ::write(ending_, &one, sizeof one); });
  thread_.join();
  ::close(ending_);
  if (link_.empty()) return;
  ::close(other_side_);
  ::close(input_);
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
}

void TerminalStream::read() {
  std::array<char, 4096> chunk;
  for (;;) {
    const bool is_full = has_no_room();
    std::array<pollfd, 2> descriptors{{{is_full ? -1 : input_, POLLIN, 0}, {ending_, POLLIN, 0}}};
    const int wait_ms = is_full ? poll_interval_ms : -1;
    local::repeat_interrupted([&] { return ::poll(descriptors.data(), descriptors.size(), wait_ms); });
    if (descriptors[1].revents != 0) return;
    if (is_full) continue;
    const ssize_t count = local::repeat_interrupted([&] { return ::read(input_, chunk.data(), chunk.size()); });
    if (count < 0 && errno == EAGAIN) continue;
    if (count <= 0) return;  // end of the input
    {
      const std::lock_guard lock(mutex_);
      arrived_.append(chunk.data(), static_cast<std::size_t>(count));
    }
    on_arrival_();
  }
}

bool TerminalStream::has_no_room() {
  const std::lock_guard lock(mutex_);
  return arrived_.size() >= unread_maximum;
}

ByteStream::Arrived TerminalStream::take() {
  const std::lock_guard lock(mutex_);
  return {false, false, std::exchange(arrived_, {})};
}

void TerminalStream::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = local::repeat_interrupted([&] { return ::write(output_, bytes.data(), bytes.size()); });
    if (count <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace inkwell::virtual_board
