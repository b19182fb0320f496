// While a real arm's force is on, a systemd-inhibit process keeps the computer from sleeping. The test replaces
// systemd-inhibit.
#include <doctest/doctest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "host/client/device/device.hpp"
#include "tests/temporary_directory.hpp"

#include "host/client/device/sleep_inhibitor.hpp"
#include "tests/host/client/device/fake_usbip_server.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;

namespace {

/// A fake systemd-inhibit. The fake logs its process id and arguments, and runs the given command.
class FakeInhibit {
 public:
  explicit FakeInhibit(const std::string& is = "exec \"$@\"") : path_before_(std::getenv("PATH")) {
    const auto program = directory_.file("systemd-inhibit");
    std::ofstream(program) << "#!/bin/sh\necho \"$$ $*\" >> '" << log() << "'\n"
                           << "while [ \"${1#--}\" != \"$1\" ]; do shift; done\n"
                           << is << "\n";
    chmod(program.c_str(), 0755);
    setenv("PATH", (directory_.path() + ":" + path_before_).c_str(), 1);
  }
  ~FakeInhibit() { setenv("PATH", path_before_.c_str(), 1); }
  FakeInhibit(const FakeInhibit&) = delete;
  FakeInhibit& operator=(const FakeInhibit&) = delete;

  struct Run {
    pid_t process;
    std::string words;
  };
  std::vector<Run> runs() const {
    std::vector<Run> runs;
    std::ifstream file(log());
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      Run run{};
      words >> run.process;
      std::getline(words >> std::ws, run.words);
      runs.push_back(run);
    }
    return runs;
  }
  bool has_begun(std::size_t count) const {
    return eventually([&] { return runs().size() >= count; });
  }

 private:
  std::string log() const { return directory_.file("log"); }
  TemporaryDirectory directory_;
  std::string path_before_;
};

/// Returns false for a process that has exited, including a zombie.
bool is_running(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  const auto name_end = line.rfind(") ");  // the state follows
  return name_end != std::string::npos && line.substr(name_end + 2, 1) != "Z";
}

/// Bits of a signal set in /proc/PROCESS/status.
std::uint64_t signals_of(pid_t process, const std::string& set) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(set + ":")) return std::stoull(line.substr(set.size() + 1), nullptr, 16);
  throw std::runtime_error("no " + set);
}

bool has_ended(pid_t process) {
  return eventually([&] { return !is_running(process); });
}

protocol::PoseReport pose_in(protocol::State state, std::uint32_t sequence, const FakeUsbipServer& server) {
  protocol::PoseReport pose{.report_id = protocol::ReportId::pose};
  pose.state = state;
  pose.sequence = sequence;
  pose.time_periods = 20 * sequence;
  pose.driver_parity = server.driver.report(0).changes & 1u;
  return pose;
}

}  // namespace

TEST_CASE("the inhibitor starts once when it is needed, and ends when it is not needed") {
  const FakeInhibit fake;
  device::SleepInhibitor inhibitor;
  inhibitor.prepare();
  inhibitor.prepare();
  for (std::size_t times = 1; times < 3; ++times) {
    inhibitor.follow(true);
    inhibitor.follow(true);
    REQUIRE(fake.has_begun(times));
    const auto runs = fake.runs();
    CHECK(runs.size() == times);
    for (const char* word : {"--what=sleep:idle", "--who=Inkwell", "--mode=block", "--why="})
      CHECK(runs.back().words.find(word) != std::string::npos);
    CHECK(is_running(runs.back().process));
    inhibitor.follow(false);
    CHECK(has_ended(runs.back().process));
  }
}

TEST_CASE("the inhibitor ends with its object, even if its program does not read") {
  const FakeInhibit fake("exec sleep 1000");
  {
    device::SleepInhibitor inhibitor;
    inhibitor.prepare();
    inhibitor.follow(true);
    REQUIRE(fake.has_begun(1));
    CHECK(is_running(fake.runs()[0].process));
  }
  CHECK_FALSE(is_running(fake.runs()[0].process));
}

TEST_CASE(
    "the inhibitor process has a separate session, no inherited files, no raised priority and default signal "
    "settings") {
  const FakeInhibit fake;
  const auto handler_before = signal(SIGUSR1, SIG_IGN);
  int ends[2];
  REQUIRE(pipe(ends) == 0);  // without close-on-exec
  device::SleepInhibitor inhibitor;
  std::thread([&] {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), -10);  // fails without the permission for it
    inhibitor.prepare();
  }).join();
  inhibitor.follow(true);
  REQUIRE(fake.has_begun(1));
  const pid_t process = fake.runs()[0].process;
  CHECK(getsid(process) == process);
  CHECK(getpriority(PRIO_PROCESS, static_cast<id_t>(process)) >= 0);
  const std::string inherited = "/fd/" + std::to_string(ends[0]);
  std::error_code none;  // the descriptor may be closed or may refer to another file
  CHECK(std::filesystem::read_symlink("/proc/" + std::to_string(process) + inherited, none) !=
        std::filesystem::read_symlink("/proc/self" + inherited));
  CHECK(signals_of(process, "SigBlk") == 0);
  CHECK((signals_of(process, "SigIgn") & 1u << (SIGUSR1 - 1)) == 0);
  close(ends[0]);
  close(ends[1]);
  signal(SIGUSR1, handler_before);
}

TEST_CASE("without systemd-inhibit, and if it refuses, nothing is wrong") {
  const FakeInhibit fake("exit 1");
  const std::string path_before = std::getenv("PATH");
  std::size_t runs = 1;
  SUBCASE("refused") {}
  SUBCASE("absent") {
    setenv("PATH", "/nowhere", 1);
    runs = 0;
  }
  {
    device::SleepInhibitor inhibitor;
    inhibitor.follow(true);  // not prepared
    inhibitor.follow(false);
    inhibitor.prepare();
    inhibitor.follow(true);
    CHECK(fake.has_begun(runs));
    inhibitor.follow(false);
  }
  CHECK(fake.runs().size() == runs);
  setenv("PATH", path_before.c_str(), 1);
}

TEST_CASE("the inhibitor ends with a killed program, even if a forked child of the program continues") {
  const FakeInhibit fake;
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t program = fork();
  if (program == 0) {
    device::SleepInhibitor inhibitor;
    inhibitor.prepare();
    inhibitor.follow(true);
    if (!fake.has_begun(1)) _exit(1);
    const pid_t child = fork();
    if (child == 0)
      while (true) pause();
    if (write(ends[1], &child, sizeof child) != sizeof child) _exit(1);
    while (true) pause();
  }
  pid_t child = 0;
  REQUIRE(read(ends[0], &child, sizeof child) == sizeof child);
  const pid_t process = fake.runs().at(0).process;
  CHECK(is_running(process));
  kill(program, SIGKILL);
  waitpid(program, nullptr, 0);
  CHECK(has_ended(process));
  CHECK(is_running(child));
  kill(child, SIGKILL);
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("a forked child that destroys its copy leaves its parent's inhibitor alone") {
  const FakeInhibit fake;
  auto inhibitor = std::make_unique<device::SleepInhibitor>();
  inhibitor->prepare();
  inhibitor->follow(true);
  REQUIRE(fake.has_begun(1));
  const pid_t process = fake.runs()[0].process;
  const pid_t child = fork();
  if (child == 0) {
    inhibitor->follow(false);
    inhibitor.reset();
    _exit(0);
  }
  int status = 1;
  waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(is_running(process));
  inhibitor.reset();
  CHECK_FALSE(is_running(process));
}

TEST_CASE("a program that drives a real arm keeps the computer from sleeping while the force is on") {
  using protocol::State;
  const FakeInhibit fake;
  FakeUsbipServer server;
  auto arm = device::Device::open(server.endpoint());
  std::uint32_t sequence = 0;
  const auto pass = [&](State state) {
    server.send(1, bytes_of(pose_in(state, ++sequence, server)));
    REQUIRE(arm->read_pose(10s));
  };
  pass(State::active);  // another program's force
  arm->claim();
  pass(State::ready);
  CHECK(fake.runs().empty());
  pass(State::active);
  REQUIRE(fake.has_begun(1));
  const pid_t process = fake.runs()[0].process;
  SUBCASE("until the force is off") { pass(State::ready); }
  SUBCASE("until it releases the arm") { arm->release(); }
  SUBCASE("until it closes the arm") { arm.reset(); }
  SUBCASE("until the arm is gone") {
    server.hang_up();
    CHECK_THROWS_AS(arm->read_pose(10s), device::Disconnected);
  }
  CHECK(has_ended(process));
  CHECK(fake.runs().size() == 1);
}

TEST_CASE("the force of a simulated arm does not keep the computer from sleeping") {
  const FakeInhibit fake;
  FakeUsbipServer server;
  auto endpoint = server.endpoint();
  endpoint.is_virtual = true;
  {
    const auto arm = device::Device::open(endpoint);
    arm->claim();
    server.send(1, bytes_of(pose_in(protocol::State::active, 1, server)));
    REQUIRE(arm->read_pose(10s));
  }
  CHECK(fake.runs().empty());
}
