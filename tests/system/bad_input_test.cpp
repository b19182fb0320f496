// Bad input, as a user would give it: a sentence that says what is wrong and what to do, and an exit code
// that is not 0.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "program.hpp"

using namespace inkwell::tests;

namespace {

std::string firmware() { return build_directory() + "/../board/inkwell.elf"; }
std::string omni() { return build_directory() + "/../../boards/arms/omni.toml"; }

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

void check_refused(const ProgramResult& result, std::initializer_list<const char*> words) {
  INFO("standard error: ", result.err);
  CHECK(result.exit_code > 0);
  CHECK(result.out.find("ready") == std::string::npos);
  for (const char* word : words) {
    INFO("missing in the message: ", word);
    CHECK(result.err.find(word) != std::string::npos);
  }
}

/// A port of this machine that is in use while this object lives.
class BusyPort {
 public:
  BusyPort() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(listen(socket_, 1) == 0);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~BusyPort() { close(socket_); }
  std::string port() const { return std::to_string(port_); }

 private:
  int socket_;
  std::uint16_t port_;
};

}  // namespace

TEST_CASE("the virtual board refuses an ELF that is missing, cut off or damaged") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("firmware.elf");
  SUBCASE("missing") { check_refused(run_program("virtual-board", {"--elf", file}), {"firmware.elf"}); }
  SUBCASE("not given") { check_refused(run_program("virtual-board", {}), {"--elf"}); }
  SUBCASE("not an ELF") {
    write_file(file, "This is a text and no program.");
    check_refused(run_program("virtual-board", {"--elf", file}), {"firmware.elf", "ELF"});
  }
  SUBCASE("cut off") {
    write_file(file, read_file(firmware()).substr(0, 200));
    check_refused(run_program("virtual-board", {"--elf", file}), {"firmware.elf"});
  }
  SUBCASE("for another processor") {
    check_refused(run_program("virtual-board", {"--elf", build_directory() + "/virtual-board"}), {"ARM"});
  }
}

TEST_CASE("the virtual board refuses a port that is in use") {
  const BusyPort busy;
  check_refused(run_program("virtual-board", {"--elf", firmware(), "--usbip", busy.port()}), {busy.port().c_str(), "--usbip"});
  check_refused(run_program("virtual-board", {"--elf", firmware(), "--control", busy.port()}),
                {busy.port().c_str(), "--control"});
}

TEST_CASE("an arm description that is wrong is refused with the line to mend") {
  const TemporaryDirectory directory;
  const std::string file = directory.file("arm.toml");
  const auto board = [&] { return run_program("virtual-board", {"--elf", firmware(), "--arm", file}); };
  const std::string good = read_file(omni());
  SUBCASE("missing") { check_refused(board(), {"arm.toml"}); }
  SUBCASE("another unit") {
    write_file(file, replaced(good, "link_2_m =", "link_2_mm ="));
    check_refused(board(), {"link_2_mm", "link_2_m", "metre"});
  }
  SUBCASE("missing key") {
    write_file(file, replaced(good, "gear_ratio_2 = 11.2", ""));
    check_refused(board(), {"gear_ratio_2"});
  }
  SUBCASE("out of range") {
    write_file(file, replaced(good, "link_3_m = 0.13335", "link_3_m = 13.335"));
    check_refused(board(), {"link_3_m", "13.335"});
  }
  SUBCASE("not TOML") {
    write_file(file, replaced(good, "\n[motor]\n", "\n[motor\n"));
    check_refused(board(), {"arm.toml", "line"});
  }
}

TEST_CASE("the companion refuses what it does not know") {
  SUBCASE("parameter") {
    check_refused(run_program("inkwell", {"--virtual", "parameters", "set", "wall_stifness_N_per_m=500"}),
                  {"wall_stifness_N_per_m", "wall_stiffness_N_per_m"});
  }
  SUBCASE("value out of range") {
    check_refused(run_program("inkwell", {"--virtual", "parameters", "set", "wall_stiffness_N_per_m=1e9"}),
                  {"wall_stiffness_N_per_m", "3000"});
  }
  SUBCASE("no number") {
    check_refused(run_program("inkwell", {"--virtual", "parameters", "set", "wall_stiffness_N_per_m=stiff"}),
                  {"stiff"});
  }
  SUBCASE("command") { check_refused(run_program("inkwell", {"dance"}), {"dance"}); }
  SUBCASE("ELF") {
    check_refused(run_program("inkwell", {"--virtual", "--elf", "nowhere.elf", "info"}), {"nowhere.elf"});
  }
}

TEST_CASE("every command explains itself") {
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"--help"}, {"info", "--help"}, {"watch", "--help"}, {"parameters", "--help"},
           {"parameters", "set", "--help"}, {"experiment", "--help"}, {"experiment", "wall", "--help"}}) {
    const auto result = run_program("inkwell", words);
    CHECK(result.exit_code == 0);
    CHECK(result.out.find("--help") != std::string::npos);
  }
  CHECK(run_program("virtual-board", {"--help"}).out.find("--real-time") != std::string::npos);
}
