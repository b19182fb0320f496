// Tests recordings on the command line: from the virtual board to a file, a replay and a plot.
#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/crash/firmware_image.hpp"
#include "host/client/device/virtual_board.hpp"
#include "host/client/recording/recording.hpp"
#include "host/client/recording/signals.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using nlohmann::json;
using protocol::Signal;

namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("a recording contains every control period and states its origin") {
  // All subcases use the same recording.
  static const TemporaryDirectory directory;
  static const auto file = directory.file("a.h5");
  static const auto run =
      run_program("inkwell", {"--virtual", "record", file, "--seconds", "1.5", "--name", "subject 7", "--json"});
  INFO("standard error: ", run.err);
  REQUIRE(run.exit_code == 0);
  const auto status = json::parse(run.out);
  CHECK(status["samples"] == 30'000);
  CHECK(status["lost"] == 0);
  CHECK(status["complete"] == true);
  CHECK(status["bytes"] == std::filesystem::file_size(file));

  const auto recording = recording::read(file);
  CHECK(recording.size() == 30'000);
  CHECK(recording.lost() == 0);
  CHECK(recording.complete);
  CHECK(recording.information.simulation);
  CHECK(recording.information.name == "subject 7");
  CHECK(recording.information.library_sha256.size() == 64);
  CHECK(recording.information.image_sha256.size() == 64);
  const auto image_check = crash::FirmwareImage(build_directory() + "/../board/inkwell.elf").check();
  REQUIRE(image_check);
  CHECK(recording.information.image_check == fmt::format("{:08x}", *image_check));
  CHECK(recording.information.arm == "PHANTOM Omni");
  CHECK(recording.information.serial_number.size() == 24);
  CHECK(recording.information.parameters == protocol::default_parameters());
  CHECK(recording.information.signals == recording::standard_signals());
  // The stylus rests in the inkwell, so the joints are stationary and the measured currents are noise.
  const auto& joint_rad = recording.column(Signal::joint_2_rad);
  CHECK(joint_rad.back() ==
        doctest::Approx(recording.information.parameters[protocol::Parameter::inkwell_joint_2_rad]).epsilon(0.02));
  bool current_varies = false;
  for (const float current_A : recording.column(Signal::current_1_A)) {
    REQUIRE(std::abs(current_A) < 0.05f);
    current_varies |= current_A != recording.column(Signal::current_1_A).front();
  }
  CHECK(current_varies);

  SUBCASE("replay describes the recording") {
    const auto described = run_program("inkwell", {"replay", file, "--json"});
    REQUIRE(described.exit_code == 0);
    const auto held = json::parse(described.out);
    CHECK(held["samples"] == 30'000);
    CHECK(held["simulation"] == true);
    CHECK(held["signals"].size() == recording::standard_signals().size());
    CHECK(held["parameters"]["wall_stiffness_N_per_m"] == 800.0);
  }
  SUBCASE("plot draws it") {
    const auto picture = directory.file("a.png");
    REQUIRE(
        run_program("inkwell", {"plot", file, "--signals", "current_1_A,joint_2_rad", "--from", "0.2", "--to", "0.4"})
            .exit_code == 0);
    CHECK(std::filesystem::file_size(picture) > 10'000);
    CHECK(read_file(picture).substr(1, 3) == "PNG");
  }
  SUBCASE("a damaged copy is refused with a sentence") {
    const auto damaged = directory.file("damaged.h5");
    std::ofstream(damaged, std::ios::binary) << read_file(file).substr(0, 700);
    for (const char* command : {"replay", "plot"}) {
      const auto refused =
          run_program("inkwell", command == std::string("replay") ? std::vector<std::string>{command, damaged, "--json"}
                                                                  : std::vector<std::string>{command, damaged});
      CHECK(refused.exit_code == 1);
      CHECK(refused.err.find("damaged.h5 is damaged") != std::string::npos);
    }
  }
  SUBCASE("it is not overwritten") {
    const auto refused = run_program("inkwell", {"--virtual", "record", file, "--seconds", "1"});
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("exists") != std::string::npos);
    CHECK(recording::read(file).size() == 30'000);
  }
}

TEST_CASE("a recording on a board that has run on since another one holds nothing of that one") {
  const TemporaryDirectory directory;
  device::VirtualBoard board{{.seed = 1}};
  auto control = board.control();
  while (!board.find()) control.run(0.1);
  control.resume();
  constexpr double recorded_s = 0.3;
  for (const double pause_s : {0.0, 0.1, 2 * recorded_s}) {
    CAPTURE(pause_s);
    std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));  // board time advances at least equally fast
    const std::string file = directory.file(std::to_string(pause_s) + ".h5");
    const auto run = run_program("inkwell", {"record", file, "--seconds", std::to_string(recorded_s), "--json",
                                             "--usbip", board.usbip().text()});
    INFO("standard error: ", run.err);
    REQUIRE(run.exit_code == 0);
    const auto status = json::parse(run.out);
    CHECK(status["samples"] == 6'000);
    CHECK(status["lost"] == 0);
  }
}

TEST_CASE("all signals go into a CSV without loss") {
  const TemporaryDirectory directory;
  const auto file = directory.file("a.csv");
  const auto run = run_program("inkwell", {"--virtual", "record", file, "--all", "--seconds", "0.5", "--json"});
  INFO("standard error: ", run.err);
  REQUIRE(run.exit_code == 0);
  const auto recording = recording::read(file);
  CHECK(recording.size() == 10'000);
  CHECK(recording.lost() == 0);
  CHECK(recording.information.signals == recording::all_signals());
  CHECK(recording.information.signals.size() == protocol::signal_count);
}

TEST_CASE("every signal that can be recorded is listed, and no device is needed for it") {
  const auto run = run_program("inkwell", {"signals"});
  CHECK(run.exit_code == 0);
  const auto listed = json::parse(run_program("inkwell", {"signals", "--json"}).out);
  REQUIRE(listed.size() == protocol::signal_count);
  for (const auto& row : protocol::signal_table) {
    CAPTURE(row.name);
    CHECK(("\n" + run.out).find("\n" + std::string(row.name) + " ") != std::string::npos);
    CHECK(listed[row.id] == json{{"name", row.name}, {"unit", row.unit}, {"help", row.help}});
  }
}

TEST_CASE("mistakes in a recording's command are found before a board is started") {
  const TemporaryDirectory directory;
  const auto misspelt = run_program("inkwell", {"--virtual", "record", directory.file("a.h5"), "--signals", "forse_N"});
  CHECK(misspelt.exit_code == 2);
  CHECK(misspelt.err.find("force_N") != std::string::npos);
  const auto format = run_program("inkwell", {"--virtual", "record", directory.file("a.mat")});
  CHECK(format.exit_code == 2);
  CHECK(format.err.find(".h5") != std::string::npos);
  CHECK(run_program("inkwell", {"plot", directory.file("none.h5")}).err.find("none.h5") != std::string::npos);
}
