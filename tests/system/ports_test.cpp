// Tests which clients the ports of a virtual board accept, and which files remain after the board's exit.
#include <doctest/doctest.h>

#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <iterator>
#include <list>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "host/client/device/address.hpp"
#include "tests/plain_client.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

namespace fs = std::filesystem;

/// The firmware echoes received UART bytes.
class BoardWithPorts {
 public:
  explicit BoardWithPorts(const std::string& port) : program_(words(port)) {
    std::istringstream line(program_.read_line());
    for (std::string word; line >> word;)
      if (const auto equals = word.find('='); equals != std::string::npos)
        addresses_[word.substr(0, equals)] = device::parse_socket(word.substr(equals + 1));
    REQUIRE(addresses_.size() == 4);
  }
  const device::SocketAddress& address(const std::string& port) const { return addresses_.at(port); }
  std::vector<std::string> ports() const {
    std::vector<std::string> names;
    for (const auto& [name, address] : addresses_) names.push_back(name);
    return names;
  }
  bool answers() const {
    PlainClient client(address("control"));
    return client.send("{\"command\":\"status\"}\n") && nlohmann::json::parse(client.line()).at("ok") == true;
  }
  void end() {
    kill(program_.process(), SIGTERM);
    CHECK(program_.wait() == 0);
  }

 private:
  /// Limits the number of files that the program can open.
  static std::vector<std::string> words(const std::string& port) {
    return {"sh", "-c",
            "ulimit -n 256; exec " + build_directory() + "/virtual-board --elf " + build_directory() +
                "/chip-firmware/echo.elf --usbip " + port + " --control " + port + " --gdb " + port +
                " --uart usart1=" + port};
  }
  RunningProgram program_;
  std::map<std::string, device::SocketAddress> addresses_;
};

mode_t mode_of(const fs::path& file) {
  struct stat status {};
  REQUIRE(::lstat(file.c_str(), &status) == 0);
  return status.st_mode & 07777;
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

}  // namespace

TEST_CASE("no port accepts a browser, and idle clients block no other client") {
  const BoardWithPorts board("0");
  for (const auto& port : board.ports()) {
    CAPTURE(port);
    for (const char* method : {"GET", "POST"}) {
      PlainClient browser(board.address(port));
      browser.send(std::string(method) + " / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
      browser.send("{\"command\":\"quit\"}\n$k#6b");
      if (port == "control") browser.line();  // the greeting
      CHECK(browser.is_closed());
    }
  }
  CHECK(board.answers());

  std::list<PlainClient> idle;
  for (int i = 0; i < 300; ++i) idle.emplace_back(board.address("control"));
  CHECK(idle.front().send("{\"command\":\"status\"}\n"));
  CHECK(nlohmann::json::parse(idle.front().line()).at("ok") == true);
  CHECK_NOTHROW(device::find_usbip_devices(board.address("usbip")));
  idle.clear();
  PlainClient terminal(board.address("uart1"));
  terminal.send("get /\n");
  CHECK(terminal.receive(6) == "GET /\n");
}

TEST_CASE("each port can be a Unix socket that only its user can open, in a folder that is gone at the end") {
  BoardWithPorts board("unix:");
  const fs::path folder = board.address("usbip").path.parent_path();
  CHECK(mode_of(folder) == 0700);
  CHECK(files_in(folder) == 4);
  for (const auto& port : board.ports()) {
    CAPTURE(port);
    CHECK(mode_of(board.address(port).path) == 0600);
  }
  CHECK(board.answers());
  CHECK_NOTHROW(device::find_usbip_devices(board.address("usbip")));
  {
    PlainClient terminal(board.address("uart1"));
    terminal.send("GET /\n");  // can only be sent by this user
    CHECK(terminal.receive(6) == "GET /\n");
    PlainClient gdb(board.address("gdb"));
    gdb.send("+$qSupported#37");
    CHECK(gdb.receive(2) == "+$");
  }
  board.end();
  CHECK_FALSE(fs::exists(folder));
}

TEST_CASE("a board that a program starts has no TCP port, and its files disappear when the program is killed") {
  const TemporaryDirectory runtime;
  RunningProgram program({build_directory() + "/inkwell", "watch", "--virtual", "--json"},
                         {"XDG_RUNTIME_DIR=" + runtime.path()});
  program.read_line();
  REQUIRE(files_in(runtime.path()) == 1);
  const fs::path folder = fs::directory_iterator(runtime.path())->path();
  CHECK(mode_of(folder) == 0700);
  CHECK(fs::is_socket(folder / "usbip"));
  CHECK(fs::is_socket(folder / "control"));
  kill(program.process(), SIGKILL);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (files_in(runtime.path()) > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(files_in(runtime.path()) == 0);
}

TEST_CASE("an address that no port can have is refused with its option") {
  for (const char* option : {"--usbip", "--control", "--gdb"})
    for (const auto& wrong : {std::string("65536"), std::string("-1"), std::string("here"), std::string("unix:/a b")}) {
      CAPTURE(option);
      CAPTURE(wrong);
      const auto result = run_program("virtual-board", {"--elf", "x.elf", option, wrong});
      CHECK(result.exit_code == 2);
      CHECK(result.err.find(std::string(option) + ": ") != std::string::npos);
    }
}
