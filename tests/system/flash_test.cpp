// Tests `inkwell flash` with the virtual board: from the firmware through the chip's boot loader to the new firmware.
#include <doctest/doctest.h>

#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/device/control_channel.hpp"
#include "tests/failure.hpp"
#include "tests/host/client/firmware_update/made_elf.hpp"

#include "tests/system/board_rig.hpp"
#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using namespace std::chrono_literals;

namespace {

std::string image(const std::string& name) { return build_directory() + "/../board/" + name; }

/// This virtual board runs in real time.
class FreeBoard {
 public:
  /// `more`: additional options, which override the default image and flash file.
  explicit FreeBoard(const std::vector<std::string>& more = {}) : program_(words(more)) {
    const std::string ready = program_.read_line();
    const auto at = ready.find("usbip=") + 6;
    port = ready.substr(at, ready.find(' ', at) - at);
  }
  device::Address address() const { return device::parse_server(port); }
  bool runs() const { return !device::find_arms(address()).empty(); }
  bool is_in_boot_loader() const { return !device::find_boot_loaders(address()).empty(); }
  void wait_until(bool (FreeBoard::*condition)() const) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!(this->*condition)()) {
      REQUIRE(std::chrono::steady_clock::now() < deadline);
      std::this_thread::sleep_for(20ms);
    }
  }
  /// Switches the power off; the flash contents remain in the file.
  void switch_off() {
    kill(program_.process(), SIGTERM);
    program_.wait();
  }
  int process() const { return program_.process(); }
  ProgramResult flash(std::vector<std::string> words) const {
    words.insert(words.begin(), {"flash", "--usbip", port});
    return run_program("inkwell", words);
  }

  std::string port;

 private:
  static std::vector<std::string> words(const std::vector<std::string>& more) {
    std::vector<std::string> words{build_directory() + "/virtual-board"};
    if (more.empty() || (more[0] != "--flash" && more[0] != "--elf"))
      words.insert(words.end(), {"--elf", image("inkwell.elf")});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  RunningProgram program_;
};

bool says(const ProgramResult& result, const std::string& words) {
  return result.err.find(words) != std::string::npos || result.out.find(words) != std::string::npos;
}

std::string write_elf(const TemporaryDirectory& directory, const std::vector<firmware_update::Segment>& segments) {
  const auto file = directory.file("made.elf");
  const auto elf = made_elf(segments);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(elf.data()), static_cast<std::streamsize>(elf.size()));
  return file;
}

}  // namespace

TEST_CASE("a newer protocol needs --yes, and the older firmware after it --allow-downgrade") {
  const FreeBoard board({"--elf", image("inkwell.elf"), "--serial", "1"});
  board.wait_until(&FreeBoard::runs);
  auto result = board.flash({image("next-protocol.elf")});
  CHECK(result.exit_code == 1);
  CHECK(says(result, "they are not compatible"));
  CHECK(says(result, "--yes"));
  CHECK_FALSE(says(result, "starting the boot loader"));

  result = board.flash({image("next-protocol.elf"), "--yes", "--json"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  auto json = nlohmann::json::parse(result.out);
  CHECK(json.at("protocol_version") == protocol::protocol_version + 1);
  CHECK(json.at("brown_out_level_set") == true);  // the brown-out reset of a new chip is disabled
  CHECK(json.at("serial_number") == "000000000000000000000001");
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 1);  // the version is different now
  for (const char* step : {"starting the boot loader", "erasing", "writing", "reading back", "starting the firmware"})
    CHECK(says(result, step));

  // Without --board, the command writes the program's image. The program finds the board although the protocol versions
  // of program and board differ.
  result = board.flash({});
  CHECK(result.exit_code == 1);
  CHECK(says(result, "which is older than the installed firmware"));
  CHECK(says(result, "--allow-downgrade"));
  CHECK_FALSE(says(result, "--yes"));
  CHECK_FALSE(says(result, "starting the boot loader"));
  CHECK(board.runs());
  result = board.flash({"--dfu", "--allow-downgrade"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(says(result, "The board contained firmware"));
  CHECK(says(result, "protocol " + std::to_string(protocol::protocol_version + 1)));
  CHECK_FALSE(says(result, "brown-out level was changed"));  // the level is already set, and a firmware update does not
                                                             // change it
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 0);
}

TEST_CASE("without a name the image is the one for the board that is there") {
  const FreeBoard board({"--elf", image("inkwell-bench_modules.elf")});
  board.wait_until(&FreeBoard::runs);
  const auto result = board.flash({"--json"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.out);
  CHECK(says(result, "inkwell-bench_modules.elf"));
  CHECK(json.at("written").get<std::string>().find("for bench_modules") != std::string::npos);
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 0);
}

TEST_CASE("an image that does not belong on the board is refused, and the old firmware goes on") {
  const TemporaryDirectory directory;
  const FreeBoard board;
  board.wait_until(&FreeBoard::runs);
  auto identity = protocol::image_identity("omni_driver", 99, 0, 0);
  SUBCASE("another board's, which the board does not even leave its firmware for") {
    const auto result =
        board.flash({write_elf(directory, made_segments(protocol::image_identity("other_board", 99, 0, 0)))});
    CHECK(result.exit_code == 1);
    CHECK(says(result, "is for the board other_board, but this board is omni_driver"));
    CHECK(says(result, "--yes"));
    CHECK_FALSE(says(result, "starting the boot loader"));
  }
  SUBCASE("an older protocol") {
    --identity.protocol_version;
    const auto result = board.flash({write_elf(directory, made_segments(identity))});
    CHECK(result.exit_code == 1);
    CHECK(says(result, "they are not compatible"));
  }
  SUBCASE("damaged") {
    auto segments = made_segments(identity);
    segments[1].bytes[100] ^= std::byte{4};
    const auto result = board.flash({write_elf(directory, segments)});
    CHECK(result.exit_code == 1);
    CHECK(says(result, "its checksum is wrong"));
  }
  board.wait_until(&FreeBoard::runs);
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 0);
}

TEST_CASE("a word of yes writes it all the same") {
  const TemporaryDirectory directory;
  const FreeBoard board({"--boot0"});
  board.wait_until(&FreeBoard::is_in_boot_loader);
  auto identity = protocol::image_identity("omni_driver", 99, 0, 0);
  --identity.protocol_version;
  // The content of the image is irrelevant for the transfer.
  const auto result = board.flash({write_elf(directory, made_segments(identity)), "--yes"});
  CHECK(says(result, "was written and verified, but the board does not respond"));
}

TEST_CASE("a flashing that was cut off is repaired by the same command") {
  const FreeBoard board;
  board.wait_until(&FreeBoard::runs);
  SUBCASE("by Ctrl-C") {
    RunningProgram flash({"sh", "-c", "exec " + build_directory() + "/inkwell flash --usbip " + board.port + " 2>&1"});
    while (flash.read_line().find("writing") == std::string::npos) {
    }
    kill(flash.process(), SIGINT);
    std::string last;
    for (std::string line; last.find("The board is in its boot loader") == std::string::npos;) last = flash.read_line();
    CHECK(last.find("run the same command again") != std::string::npos);
    CHECK(flash.wait() == 1);
  }
  SUBCASE("by a death of the program") {
    RunningProgram flash({"sh", "-c", "exec " + build_directory() + "/inkwell flash --usbip " + board.port + " 2>&1"});
    while (flash.read_line().find("reading back") == std::string::npos) {
    }
    kill(flash.process(), SIGKILL);
    flash.wait();
  }
  CHECK(board.is_in_boot_loader());
  const auto result = board.flash({});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(says(result, "The board contained unidentified data"));  // the interrupted command has erased the start of the
                                                                 // image
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 0);
}

TEST_CASE("a board whose power went in the middle does nothing until BOOT0 is held, and is repaired then") {
  const TemporaryDirectory directory;
  const auto flash_file = directory.file("board.flash");
  REQUIRE(run_program("inkwell", {"flash", "--virtual", flash_file}).exit_code == 0);
  {
    FreeBoard board({"--flash", flash_file});
    board.wait_until(&FreeBoard::runs);
    RunningProgram flash({"sh", "-c", "exec " + build_directory() + "/inkwell flash --usbip " + board.port + " 2>&1"});
    while (flash.read_line().find("reading back") == std::string::npos) {
    }
    kill(flash.process(), SIGKILL);
    flash.wait();
    board.switch_off();
  }
  {
    FreeBoard board({"--flash", flash_file});
    const std::string owner = fmt::format("virtual-board (process {})", board.process());
    for (const auto& second : {run_program("virtual-board", {"--flash", flash_file}),
                               run_program("inkwell", {"info", "--virtual", "--flash", flash_file}),
                               run_program("inkwell", {"flash", "--virtual", flash_file, "--yes"})}) {
      INFO(second.err);
      CHECK(second.exit_code == 1);
      CHECK(says(second, flash_file + " is in use by " + owner));
    }
    std::this_thread::sleep_for(500ms);
    CHECK_FALSE(board.runs());
    CHECK_FALSE(board.is_in_boot_loader());
    board.switch_off();
  }
  FreeBoard board({"--flash", flash_file, "--boot0"});
  board.wait_until(&FreeBoard::is_in_boot_loader);
  const auto result = board.flash({});
  INFO(result.err);
  CHECK(result.exit_code == 0);
  CHECK(run_program("inkwell", {"info", "--usbip", board.port}).exit_code == 0);
}

TEST_CASE("the firmware does not leave while the force is on") {
  BoardRig rig;
  rig.make_active();
  CHECK_THROWS_AS(device::detach_firmware(*rig.board.find()), device::Stalled);
  rig.run(0.05);
  CHECK(protocol::force_is_on(rig.pose().state));
}

TEST_CASE("flashing without a board or without openocd prints an error with a remedy") {
  const auto nobody = run_program("inkwell", {"flash", "--usbip", "1"});
  CHECK(nobody.exit_code == 1);
  CHECK(says(nobody, "No program answers"));
  const auto none = run_program("inkwell", {"flash", "nowhere.elf"});
  CHECK(none.exit_code == 1);
  CHECK(says(none, "The firmware nowhere.elf does not exist"));
  CHECK(run_program("inkwell", {"--virtual", "flash"}).exit_code == 2);
  CHECK(run_program("inkwell", {"flash", "--swd", "--dfu"}).exit_code == 2);
  CHECK(run_program("inkwell", {"flash", "--virtual"}).exit_code == 2);
  const auto no_probe = run_program(
      "/usr/bin/env", {"PATH=/nowhere", build_directory() + "/inkwell", "flash", "--swd", image("inkwell.elf")});
  CHECK(no_probe.exit_code == 1);
  CHECK(says(no_probe, "Install it"));
}

TEST_CASE("an update by a probe writes the named board's image, and its failure is reported") {
  const TemporaryDirectory directory;
  const auto called = directory.file("called");
  const auto fake = directory.file("openocd");
  // The fake openocd finds an erased flash. The fake openocd then reports that
  // the image is verified, and prints the marker from its arguments.
  std::ofstream(fake) << "#!/bin/sh\ncase \"$*\" in *dump_image*) head -c 1000 /dev/zero >installed.bin; exit;; esac\n"
                      << "for word in \"$@\"; do echo \"$word\"; done >" << called << "\ncat image.hex >>" << called
                      << "\nsed -n 's/^echo {\\(.*\\)}$/\\1/p' " << called << "\nexit ${FAKE_RESULT:-0}\n";
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const std::string path = "PATH=" + directory.path() + ":/usr/bin:/bin", companion = build_directory() + "/inkwell";
  const auto output_of = [&] {
    std::ifstream file(called);
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  const auto done =
      run_program("/usr/bin/env", {path, companion, "flash", "--swd", "--interface", "jlink", image("inkwell.elf")});
  CHECK(done.exit_code == 0);
  CHECK(contains(output_of(), "interface/jlink.cfg"));
  CHECK(contains(output_of(), "6E695F647269766572"));  // ni_driver
  const auto failed =
      run_program("/usr/bin/env", {path, "FAKE_RESULT=1", companion, "flash", "--swd", "--board", "omni_driver"});
  CHECK(failed.exit_code == 1);
  CHECK(says(failed, "the probe is connected"));

  // With --board, openocd receives the installed image of this board. Without --board, the command fails before it
  // calls openocd.
  CHECK(run_program("/usr/bin/env", {path, companion, "flash", "--swd", "--board", "bench_modules"}).exit_code == 0);
  CHECK(contains(output_of(), "6E63685F6D6F64756C6573"));  // nch_modules
  std::filesystem::remove(called);
  const auto nameless = run_program("/usr/bin/env", {path, companion, "flash", "--swd"});
  CHECK(nameless.exit_code == 2);
  CHECK(says(nameless, "--board: bench_modules, omni_driver"));
  const auto path_as_interface =
      run_program("/usr/bin/env", {path, companion, "flash", "--swd", "--interface", "../x", "--board", "omni_driver"});
  CHECK(path_as_interface.exit_code == 2);
  CHECK(says(path_as_interface, "--interface"));
  CHECK_FALSE(std::filesystem::exists(called));
}
