#include <doctest/doctest.h>

#include <csignal>

#include "host/client/command_line/interrupt.hpp"

using namespace inkwell;

TEST_CASE("Ctrl-C, SIGTERM and a closed terminal interrupt a command, and not the program after it") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CAPTURE(signal);
    const auto before = std::signal(signal, SIG_DFL);
    {
      const command_line::InterruptGuard guard;
      CHECK_FALSE(guard.is_interrupted());
      std::raise(signal);
      CHECK(guard.is_interrupted());
    }
    CHECK_FALSE(command_line::InterruptGuard().is_interrupted());
    const bool is_default = std::signal(signal, before) == SIG_DFL;
    CHECK(is_default);
  }
}

TEST_CASE("a command that was started with nohup survives a closed terminal") {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    const command_line::InterruptGuard guard;
    std::raise(SIGHUP);
    CHECK_FALSE(guard.is_interrupted());
  }
  const bool is_ignored = std::signal(SIGHUP, before) == SIG_IGN;
  CHECK(is_ignored);
}
