// Tests the commands for the stored parameters, such as `inkwell parameters store`, across a board restart.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/device/virtual_board.hpp"
#include "protocol/parameters.hpp"
#include "protocol/store.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

struct RememberingBoard {
  TemporaryDirectory directory;
  std::string flash = directory.file("flash.bin");
  device::VirtualBoard board{{.flash = flash}};
  device::ControlClient control = board.control();

  RememberingBoard() { wait_for_device(); }

  void wait_for_device() {
    while (!board.find()) control.run(0.1);
    control.run(0.5);
    control.resume();
  }
  void restart() {
    control.reset();
    control.run(0.05);
    wait_for_device();
  }
  ProgramResult run(std::vector<std::string> words) {
    words.insert(words.end(), {"--usbip", board.usbip().text()});
    return run_program("inkwell", words);
  }
  nlohmann::json json(std::vector<std::string> words) {
    words.push_back("--json");
    const auto result = run(words);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.out);
  }
  void done(const std::vector<std::string>& words) {
    const auto result = run(words);
    INFO(result.err);
    REQUIRE(result.exit_code == 0);
  }
  double stiffness() { return json({"parameters", "get", "wall_stiffness_N_per_m"}).at("wall_stiffness_N_per_m"); }
};

const double default_stiffness =
    static_cast<double>(protocol::info(protocol::Parameter::wall_stiffness_N_per_m).default_value);

}  // namespace

TEST_CASE("values last until the board's power goes, unless they are stored") {
  RememberingBoard board;
  board.done({"parameters", "set", "wall_stiffness_N_per_m=600"});
  board.restart();
  CHECK(board.stiffness() == default_stiffness);

  board.done({"parameters", "set", "wall_stiffness_N_per_m=600"});
  CHECK(board.run({"parameters", "store"}).out == "The parameters are stored on the board and survive power loss.\n");
  board.restart();
  CHECK(board.stiffness() == 600);

  board.done({"parameters", "set", "wall_stiffness_N_per_m=700"});
  board.done({"parameters", "restore"});
  CHECK(board.stiffness() == 600);
}

TEST_CASE("values that differ from the stored values are marked, counted and listed with the stored value") {
  RememberingBoard board;
  CHECK(board.run({"parameters"}).out.find("After the next start, the board has the same parameter values") !=
        std::string::npos);
  board.done({"parameters", "set", "wall_stiffness_N_per_m=600", "wall_damping_Ns_per_m=3"});
  board.done({"parameters", "store"});
  board.done({"parameters", "set", "wall_stiffness_N_per_m=700"});

  const auto listed = board.run({"parameters"}).out;
  const auto row_of = [&](const std::string& name) {
    const auto begin = listed.find("  " + name + " ");
    REQUIRE(begin != std::string::npos);
    return listed.substr(begin, listed.find('\n', begin) - begin);
  };
  CHECK(row_of("wall_stiffness_N_per_m").find("700.0 *!") != std::string::npos);
  CHECK(row_of("wall_damping_Ns_per_m").find("3.0 * ") != std::string::npos);
  CHECK(listed.find("! 1 value is not stored") != std::string::npos);
  for (const auto& row : board.json({"parameters"}))
    if (row.at("name") == "wall_stiffness_N_per_m") CHECK(row.at("stored") == 600);

  const auto stored = board.json({"parameters", "stored"});
  CHECK(stored.at("contents") == "parameters");
  REQUIRE(stored.at("not_stored").size() == 1);
  CHECK(stored.at("not_stored")[0].at("name") == "wall_stiffness_N_per_m");
  CHECK(stored.at("not_stored")[0].at("value") == 700);
  CHECK(stored.at("not_stored")[0].at("stored") == 600);
  CHECK(stored.at("records_written") == 1);
  CHECK(stored.at("at_start").at("contents") == "nothing");
  CHECK(board.run({"parameters", "stored"}).out.find("wall_stiffness_N_per_m") != std::string::npos);
  const auto information = board.json({"info"});
  CHECK(information.at("stored") == "parameters");
  CHECK(information.at("not_stored") == 1);

  board.restart();
  const auto after = board.json({"parameters", "stored"});
  CHECK(after.at("not_stored").empty());
  CHECK(after.at("at_start").at("contents") == "parameters");
  CHECK(after.at("at_start").at("firmware_version") == board.json({"info"}).at("firmware_version"));
  CHECK(after.at("at_start").at("unknown") == 0);
}

TEST_CASE("a factory reset requires --yes, erases the stored parameters and restores the defaults") {
  RememberingBoard board;
  board.done({"parameters", "set", "wall_stiffness_N_per_m=600"});
  board.done({"parameters", "store"});
  const auto refused = board.run({"parameters", "factory"});
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("calibration") != std::string::npos);
  CHECK(refused.err.find("--yes") != std::string::npos);
  board.restart();
  CHECK(board.stiffness() == 600);

  CHECK(board.run({"parameters", "factory", "--yes"}).exit_code == 0);
  CHECK(board.stiffness() == default_stiffness);
  board.restart();
  CHECK(board.stiffness() == default_stiffness);
  const auto nothing = board.run({"parameters", "restore"});
  CHECK(nothing.exit_code == 1);
  CHECK(nothing.err.find("no stored parameters to restore") != std::string::npos);
}

TEST_CASE("while the force is on, parameters are neither stored nor erased, and the board reports the reason") {
  RememberingBoard board;
  board.done({"parameters", "set", "wall_stiffness_N_per_m=600", "host_timeout_s=2"});
  const auto& reason = info(protocol::StoreResult::force_is_on);
  for (auto words :
       std::vector<std::vector<std::string>>{{"parameters", "store"}, {"parameters", "factory", "--yes"}}) {
    RunningProgram on({build_directory() + "/inkwell", "force", "on", "--usbip", board.board.usbip().text()});
    REQUIRE(on.read_line() == "The force is on.");
    const auto beside_the_driver = board.run(words);
    CHECK(beside_the_driver.exit_code == 1);
    CHECK(beside_the_driver.err.find("The arm is driven by inkwell") != std::string::npos);

    words.push_back("--take-over");
    const auto refused = board.run(words);
    CHECK(refused.exit_code == 1);
    CHECK(refused.err.find(reason.meaning) != std::string::npos);
    CHECK(refused.err.find(reason.remedy) != std::string::npos);
  }
  board.done({"force", "off"});
  CHECK(board.stiffness() == 600);
  CHECK(board.json({"parameters", "stored"}).at("records_written") == 0);
}

TEST_CASE("a virtual board of one command retains stored parameters in a file") {
  const TemporaryDirectory directory;
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--virtual", "--flash", directory.file("flash.bin")});
    return run_program("inkwell", words);
  };
  const auto tuned = run({"tune", "current-loop", "--motor", "2", "--yes", "--apply", "--store", "--json"});
  INFO(tuned.err);
  REQUIRE(tuned.exit_code == 0);
  const auto guide = nlohmann::json::parse(tuned.out);
  CHECK(guide.at("stored") == true);
  for (const auto& proposal : guide.at("proposals")) {
    const auto held = run({"parameters", "get", proposal.at("parameter")});
    CHECK(std::stod(held.out) == doctest::Approx(proposal.at("proposed").get<double>()));
  }
  const auto again = run({"tune", "current-loop", "--motor", "2", "--bandwidth", "600", "--yes", "--apply", "--json"});
  CHECK(nlohmann::json::parse(again.out).at("stored") == false);
  CHECK(again.err.find("Add --store to keep these values.") != std::string::npos);
  CHECK(again.err.find("`inkwell parameters store`") == std::string::npos);
}

TEST_CASE("values that a virtual board of one command would lose are reported, and --store saves them") {
  const TemporaryDirectory directory;
  const std::string flash = directory.file("flash.bin");
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "parameters");
    words.insert(words.end(), {"--virtual", "--flash", flash});
    return run_program("inkwell", words);
  };
  const auto stiffness = [&] { return std::stod(run({"get", "wall_stiffness_N_per_m"}).out); };
  const auto lost = run({"set", "wall_stiffness_N_per_m=600"});
  REQUIRE(lost.exit_code == 0);
  CHECK(lost.err.find("flash.bin contains only stored values. Add --store") != std::string::npos);
  CHECK(stiffness() == default_stiffness);

  const auto kept = run({"set", "wall_stiffness_N_per_m=700", "--store", "--json"});
  REQUIRE(kept.exit_code == 0);
  CHECK(kept.err.empty());
  CHECK(nlohmann::json::parse(kept.out).at("stored") == true);
  CHECK(stiffness() == 700);
  REQUIRE(run({"defaults", "--store"}).exit_code == 0);
  CHECK(stiffness() == default_stiffness);

  const auto without_file = run_program("inkwell", {"parameters", "set", "wall_stiffness_N_per_m=600", "--virtual"});
  CHECK(without_file.err.find("Use --flash FILE and --store") != std::string::npos);
}

TEST_CASE("a virtual board without a file reports that its parameters are lost") {
  const auto stored = run_program("inkwell", {"parameters", "store", "--virtual"});
  CHECK(stored.exit_code == 0);
  CHECK(stored.err.find("--flash FILE") != std::string::npos);
  CHECK(run_program("inkwell", {"parameters", "store", "--flash", "file"}).exit_code == 2);
}
