#include <doctest/doctest.h>

#include <fcntl.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <thread>

#include "host/client/command_line/interrupt.hpp"
#include "host/companion/command_line/mark_keys.hpp"

using namespace inkwell::command_line;

namespace {

void type(int descriptor, std::string_view text) {
  REQUIRE(write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
}

}  // namespace

TEST_CASE("each line from a pipe sets a mark with the line's text") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  MarkKeys keys(ends[0]);
  CHECK_FALSE(keys.next());
  type(ends[1], "touch\n\nlet");
  CHECK(keys.next() == "touch");
  CHECK(keys.next() == "mark 2");
  CHECK_FALSE(keys.next());  // the line is incomplete
  type(ends[1], " go\n");
  close(ends[1]);
  CHECK(keys.next() == "let go");
  CHECK_FALSE(keys.next());
  close(ends[0]);
}

TEST_CASE("on a terminal the space bar sets a mark immediately, and the terminal settings are restored") {
  const int keyboard = posix_openpt(O_RDWR | O_NOCTTY);
  if (keyboard < 0) {
    MESSAGE("skipped: this computer has no pseudo-terminals (/dev/ptmx): ", std::strerror(errno));
    return;
  }
  REQUIRE(unlockpt(keyboard) == 0);
  const int terminal = ioctl(keyboard, TIOCGPTPEER, O_RDWR | O_NOCTTY);  // in a container the path name may not exist
  REQUIRE(terminal >= 0);
  termios before, during, after;
  tcgetattr(terminal, &before);
  {
    MarkKeys keys(terminal);
    tcgetattr(terminal, &during);
    CHECK((during.c_lflag & static_cast<tcflag_t>(ICANON | ECHO)) == 0);
    CHECK((during.c_lflag & static_cast<tcflag_t>(ISIG)) != 0);
    type(keyboard, "x  ");
    CHECK(keys.next() == "mark 1");
    CHECK(keys.next() == "mark 2");
    CHECK_FALSE(keys.next());
  }
  tcgetattr(terminal, &after);
  CHECK(after.c_lflag == before.c_lflag);
  close(terminal);
  close(keyboard);
}

TEST_CASE("an interrupt is recorded while an InterruptGuard exists") {
  InterruptGuard guard;
  CHECK_FALSE(guard.is_interrupted());
  raise(SIGINT);
  CHECK(guard.is_interrupted());
}
