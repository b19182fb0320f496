// Tests the virtual board's UARTs on pipes, on a pseudo-terminal and on a socket.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/system/program.hpp"

using namespace inkwell::tests;

namespace {

RunningProgram board_with_uart(const std::string& target) {
  return RunningProgram({build_directory() + "/virtual-board", "--elf", build_directory() + "/chip-firmware/echo.elf",
                         "--uart", "usart1=" + target});
}

/// Returns the echo of `text` on an open descriptor.
std::string echo(int descriptor, const std::string& text) {
  REQUIRE(::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  std::string answer;
  while (answer.size() < text.size()) {
    pollfd readable{descriptor, POLLIN, 0};
    constexpr int patience_ms = 60'000;
    char byte = 0;
    if (::poll(&readable, 1, patience_ms) <= 0 || ::read(descriptor, &byte, 1) != 1) break;
    answer += byte;
  }
  return answer;
}

}  // namespace

TEST_CASE("a UART on standard input and output") {
  RunningProgram board = board_with_uart("stdio");
  CHECK(board.read_line().starts_with("ready "));
  board.write_line("hello, board");
  CHECK(board.read_line() == "HELLO, BOARD");
}

TEST_CASE("a UART has a separate terminal, and the terminal disappears with the board") {
  const TemporaryDirectory directory;
  const auto path = directory / "uart";
  {
    RunningProgram board = board_with_uart(path.string());
    board.read_line();
    const int terminal = ::open(path.c_str(), O_RDWR | O_NOCTTY);
    REQUIRE(terminal >= 0);
    CHECK(echo(terminal, "a\nb\r\x03!") == "A\nB\r\x03!");  // bytes pass unchanged
    ::close(terminal);
    const auto taken = run_program("virtual-board", {"--elf", build_directory() + "/chip-firmware/echo.elf", "--uart",
                                                     "usart1=" + path.string(), "--seconds", "0.001"});
    CHECK(taken.exit_code == 1);
    CHECK(taken.err.find(path.string()) != std::string::npos);
    ::kill(board.process(), SIGTERM);
    CHECK(board.wait() == 0);
  }
  CHECK_FALSE(std::filesystem::is_symlink(path));
}

TEST_CASE("a UART on a socket") {
  RunningProgram board = board_with_uart("0");
  const std::string ready = board.read_line(), mark = " uart1=";
  const auto at = ready.find(mark);
  REQUIRE(at != std::string::npos);
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoul(ready.substr(at + mark.size()))));
  REQUIRE(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  CHECK(echo(socket, "over tcp") == "OVER TCP");
  ::close(socket);
}

TEST_CASE("an invalid UART, pin or file is refused") {
  const auto said = [](std::initializer_list<std::string> options) {
    std::vector<std::string> arguments{"--elf", build_directory() + "/chip-firmware/echo.elf", "--seconds", "0.001"};
    arguments.insert(arguments.end(), options);
    return run_program("virtual-board", arguments);
  };
  for (const char* wrong : {"usart7=stdio", "usart1", "usart1=", "usart1=70000"}) {
    CAPTURE(wrong);
    const auto result = said({"--uart", wrong});
    CHECK(result.exit_code == 2);
    CHECK(result.err.find(wrong) != std::string::npos);
  }
  CHECK(said({"--vcd", "/nowhere/at/all.vcd"}).exit_code == 1);
  CHECK(said({"--vcd", "/dev/null", "--vcd-pins", "PA8,PZ1"}).exit_code == 2);
  CHECK(said({"--vcd", "/dev/null", "--vcd-pins", "PA8,PC6"}).exit_code == 0);
}
