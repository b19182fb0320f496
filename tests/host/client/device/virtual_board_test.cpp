// Tests how a program starts and stops a virtual board. Shell scripts replace the virtual board.
#include <doctest/doctest.h>

#include <signal.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "host/client/device/virtual_board.hpp"
#include "host/client/local/listener.hpp"
#include "tests/failure.hpp"

#include "tests/host/client/device/fake_usbip_server.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

/// A program in a temporary folder, which is deleted after the test.
class Script {
 public:
  explicit Script(const std::string& lines) {
    std::ofstream(program()) << "#!/bin/sh\ncd '" << folder_.path() << "'\n" << lines;
    std::filesystem::permissions(program(), std::filesystem::perms::owner_all);
  }
  std::filesystem::path program() const { return folder_ / "board"; }
  device::VirtualBoardOptions options() const { return {.program = program(), .elf = program()}; }
  /// Returns the content of a file that the script wrote, or an empty string.
  std::string file(const char* name) const {
    std::string line;
    std::getline(std::ifstream(folder_ / name), line);
    return line;
  }

 private:
  TemporaryDirectory folder_;
};

constexpr char run_until_reported[] = "echo $$ > process\necho ready usbip=7 control=8\nwhile :; do sleep 0.01; done\n";

std::string failure_of(const device::VirtualBoardOptions& options) {
  return message_of<device::Error>([&] { device::VirtualBoard board(options); });
}

}  // namespace

TEST_CASE("a virtual board receives SIGTERM, so that it can exit normally") {
  const Script script(std::string("trap 'echo asked > end; exit 0' TERM\n") + run_until_reported);
  {
    device::VirtualBoard board(script.options());
    CHECK(board.usbip() == device::SocketAddress{.host = "127.0.0.1", .port = 7});
    CHECK(board.control_socket() == device::SocketAddress{.host = "127.0.0.1", .port = 8});
    CHECK(board.is_running());
    CHECK(script.file("end").empty());
  }
  CHECK(script.file("end") == "asked");
}

TEST_CASE("a virtual board that ignores SIGTERM is killed") {
  const Script script(std::string("trap '' TERM\n") + run_until_reported);
  pid_t process = 0;
  {
    device::VirtualBoard board(script.options());
    process = std::stoi(script.file("process"));
    CHECK(kill(process, 0) == 0);
  }
  CHECK(kill(process, 0) != 0);
}

TEST_CASE("the sockets of a killed virtual board are removed") {
  const TemporaryDirectory parent;
  std::filesystem::create_directory(parent / "private");
  // With the umask 002, which is the default of Debian 13, the group may write the new folder.
  std::filesystem::permissions(parent / "private", std::filesystem::perms::owner_all);
  const local::Listener usbip({.path = parent / "private/usbip"}, "--usbip"),
      control({.path = parent / "private/control"}, "--control");
  const Script script("echo ready usbip=" + usbip.address().text() + " control=" + control.address().text() +
                      "\nexec sleep 60\n");
  {
    const device::VirtualBoard board(script.options());
    CHECK(board.usbip() == usbip.address());
    CHECK(board.control_socket() == control.address());
  }
  CHECK(std::filesystem::is_empty(parent.path()));
}

TEST_CASE("a virtual board ends with the thread that made it") {
  const Script script(std::string("trap 'echo asked > end; exit 0' TERM\n") + run_until_reported);
  std::unique_ptr<device::VirtualBoard> board;
  std::thread([&] { board = std::make_unique<device::VirtualBoard>(script.options()); }).join();
  CHECK(eventually([&] { return script.file("end") == "asked"; }));
  CHECK(eventually([&] { return !board->is_running(); }));
}

TEST_CASE("the error of a virtual board that does not start contains its output") {
  CHECK(contains(failure_of(Script("echo the port is taken >&2\nexit 1\n").options()), "the port is taken"));
  CHECK(contains(failure_of(Script("exit 1\n").options()), "It said nothing"));
  CHECK(contains(failure_of(Script("echo hello\nexec sleep 60\n").options()), "did not start"));
  CHECK(contains(failure_of(Script("echo ready usbip=x control=8\nexec sleep 60\n").options()), "did not start"));
  CHECK(contains(failure_of(Script("echo ready usbip=7\nexec sleep 60\n").options()), "did not start"));
  CHECK(contains(failure_of(Script("exec cat /dev/zero\n").options()), "did not start"));
  const Script script("");
  auto options = script.options();
  options.elf = "/nowhere.elf";
  CHECK(contains(failure_of(options), "/nowhere.elf is missing"));
  options.program = "/nowhere";
  CHECK(contains(failure_of(options), "/nowhere is missing"));
}

TEST_CASE("a virtual board gets its options") {
  const Script script(std::string("echo \"$@\" > arguments\n") + run_until_reported);
  auto options = script.options();
  options.arm = "arm.toml";
  options.mode = device::SimulationMode::exact;
  options.pricing = device::CyclePricing::conservative;
  options.seed = 42;
  options.paused = true;
  const device::VirtualBoard board(options);
  CHECK(script.file("arguments") == "--elf " + options.elf.string() +
                                        " --usbip unix: --control unix: --mode exact --pricing conservative --seed 42 "
                                        "--arm arm.toml --real-time --paused");
}

TEST_CASE("a virtual board gets the options that are seldom given, and no others") {
  const Script script(std::string("echo \"$@\" > arguments\n") + run_until_reported);
  auto options = script.options();
  options.host_clock_ppm = -500.0;
  options.brown_out_level = 3;
  options.real_time = false;
  options.strict = true;
  options.profile = "longest.txt";
  const device::VirtualBoard board(options);
  CHECK(script.file("arguments") ==
        "--elf " + options.elf.string() +
            " --usbip unix: --control unix: --mode fast --pricing likely --seed 1 --host-clock-ppm -500.000000 "
            "--brown-out 3 --strict --profile longest.txt");
}

TEST_CASE("the error of a virtual board that failed contains only the end of its output") {
  const Script script(
      "i=0\nwhile [ $i -lt 500 ]; do echo some of the many lines >&2; i=$((i + 1)); done\n"
      "echo the last one >&2\nexit 1\n");
  const auto message = failure_of(script.options());
  CHECK(message.ends_with("the last one"));
  CHECK(message.size() < 4200);
}

TEST_CASE("a terminal's Ctrl-C does not reach a virtual board, and no file but its own does") {
  const Script script(
      "read -r words < /proc/$$/stat\nset -- $words\necho $5 > group\n"
      "for file in /proc/$$/fd/*; do readlink $file; done | grep pipe | sort | uniq -d > twice\n" +
      std::string(run_until_reported));
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const auto open_before = open_files();
  {
    const device::VirtualBoard board(script.options());
    CHECK(script.file("group") == script.file("process"));
    CHECK(script.file("twice").empty());
    CHECK(open_files() == open_before + 2);  // two read ends; an open write end would prevent end-of-file
  }
  CHECK(open_files() == open_before);
}
