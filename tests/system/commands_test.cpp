// Tests the commands that observe an arm in real time.
#include <doctest/doctest.h>

#include <signal.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/device/device.hpp"
#include "host/client/device/virtual_board.hpp"
#include "host/client/recording/recording.hpp"
#include "protocol/black_box.hpp"
#include "protocol/scope.hpp"

#include "tests/stepped_board.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
using namespace inkwell::tests;

namespace {

struct BoardAndCompanion {
  device::VirtualBoard board{device::VirtualBoardOptions{}};
  device::ControlClient control = board.control();

  std::vector<std::string> words(std::vector<std::string> command) const {
    command.insert(command.end(), {"--usbip", board.usbip().text()});
    return command;
  }
  ProgramResult run(const std::vector<std::string>& command) { return run_program("inkwell", words(command)); }
  /// Waits until the device of the board appears.
  void wait_for_device() {
    while (!board.find()) control.run(0.1);
    control.run(0.5);
    control.resume();
    // On a busy computer the companion may send signs of life late, so the timeout is long.
    REQUIRE(run({"parameters", "set", "host_timeout_s=2"}).exit_code == 0);
  }
};

}  // namespace

TEST_CASE("a fault is shown with its remedy, and can be cleared after its cause has disappeared") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto well = rig.run({"fault"});
  CHECK(well.exit_code == 0);
  CHECK(well.out.starts_with("No fault."));

  rig.control.inject({"bridge_fault"});
  rig.control.run(0.01);
  rig.control.resume();
  const auto shown = rig.run({"fault"});
  CHECK(shown.exit_code == 0);
  CHECK(shown.out.find("A bridge reported") != std::string::npos);
  CHECK(shown.out.find("let the bridges cool") != std::string::npos);
  CHECK(nlohmann::json::parse(rig.run({"fault", "--json"}).out).at("fault") == "bridge_fault");
  const auto again = rig.run({"fault", "clear"});
  CHECK(again.exit_code == 1);
  INFO(again.err);
  CHECK(again.err.find("The board has raised the fault again. bridge_fault: A bridge reported") != std::string::npos);

  rig.control.heal("bridge_fault");
  const auto cleared = rig.run({"fault", "clear"});
  CHECK(cleared.exit_code == 0);
  CHECK(cleared.out.starts_with("No fault."));
}

TEST_CASE("the black box is reported, saved as a recording, and removed when the force is switched on") {
  const TemporaryDirectory directory;
  const auto file = directory.file("fault.h5"), table = directory.file("fault.csv");
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto check_none = [&] {
    const auto refused = rig.run({"fault", "--out", file});
    CHECK(refused.exit_code == 1);
    CHECK(refused.err.find("No black box is recorded") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(file));
    CHECK(nlohmann::json::parse(rig.run({"fault", "--json"}).out).at("black_box").is_null());
    CHECK(rig.run({"fault"}).out.find("black box") == std::string::npos);
  };
  check_none();

  rig.control.inject({"bridge_fault"});
  rig.control.run(0.01);  // the recording is still in progress
  rig.control.resume();
  const auto saved = rig.run({"fault", "--out", table});
  INFO(saved.err);
  REQUIRE(saved.exit_code == 0);
  CHECK(saved.out.find("bridge_fault at ") != std::string::npos);
  CHECK(saved.out.find(fmt::format("201 samples of {} signals", protocol::signal_count)) != std::string::npos);
  const auto recording = recording::read(table);
  CHECK(recording.complete);
  CHECK(recording.size() == protocol::black_box_rows_maximum);
  CHECK(recording.lost() == 0);
  CHECK(recording.information.simulation);
  CHECK(recording.duration_s() == doctest::Approx(0.2).epsilon(0.005));
  REQUIRE(recording.marks.size() == 1);
  CHECK(recording.marks[0].text == "bridge_fault");
  CHECK(recording.marks[0].period == recording.periods[protocol::black_box_rows_before]);

  const auto shown = rig.run({"fault"});
  CHECK(shown.out.find("The board has recorded a black box: every signal around bridge_fault") != std::string::npos);
  CHECK(shown.out.find("Save it with `inkwell fault --out FILE`") != std::string::npos);
  CHECK(shown.out.find("exception") == std::string::npos);
  const auto json = nlohmann::json::parse(rig.run({"fault", "--out", file, "--json"}).out);
  CHECK(json.at("file") == file);
  CHECK(json.at("black_box").at("fault") == "bridge_fault");
  CHECK(json.at("black_box").at("rows") == 201);
  CHECK(json.at("black_box").at("rows_before") == 100);
  CHECK(json.at("black_box").at("complete") == true);
  CHECK(json.at("black_box").at("restart") == false);
  CHECK(json.at("black_box").at("crash").is_null());
  CHECK(json.at("black_box").at("time_s").get<double>() == doctest::Approx(recording.marks[0].period / 20e3));
  CHECK(recording::read(file).periods == recording.periods);
  CHECK(nlohmann::json::parse(run_program("inkwell", {"replay", file, "--json"}).out).at("lost") == 0);
  CHECK(run_program("inkwell", {"plot", file, "--signals", "supply_V,force_N"}).exit_code == 0);

  const auto exists = rig.run({"fault", "--out", file});
  CHECK(exists.exit_code == 2);
  CHECK(exists.err.find("already exists. Give another name, or add --overwrite to replace") != std::string::npos);
  CHECK(rig.run({"fault", "--out", file, "--overwrite"}).exit_code == 0);
  for (const auto& words : std::vector<std::vector<std::string>>{{"fault", "--overwrite"},
                                                                 {"fault", "--out", ""},
                                                                 {"fault", "--out", directory.file("fault.mat")},
                                                                 {"fault", "clear", "--out", directory.file("b.h5")}}) {
    const auto refused = rig.run(words);
    CHECK(refused.exit_code == 2);
    CHECK_FALSE(refused.err.empty());
  }

  rig.control.heal("bridge_fault");
  rig.control.run(0.01);
  rig.control.resume();
  CHECK(rig.run({"fault", "clear"}).out.find("The board has recorded a black box") != std::string::npos);
  CHECK(rig.run({"force", "on", "--seconds", "0.1"}).exit_code == 0);
  std::filesystem::remove(file);
  check_none();
}

TEST_CASE("the reference lists the position and the meaning of each field of the reports") {
  const auto reference = run_program("inkwell", {"reference"}).out;
  const auto row_of = [&](const std::string& structure, const std::string& field) {
    const auto section = reference.find("\n### " + structure + ", ");
    REQUIRE(section != std::string::npos);
    const auto name = reference.find(" | `" + field + "` | ", section);
    REQUIRE(name < reference.find("\n### ", section + 1));
    const auto begin = reference.rfind('\n', name) + 1;
    return reference.substr(begin, reference.find('\n', begin) - begin);
  };
  using protocol::PoseReport, protocol::ScopeFrameHeader, protocol::CommandReport;
  CHECK(row_of("PoseReport", "force_N") ==
        fmt::format("| {} | 12 | float[3] | `force_N` |  |", offsetof(PoseReport, force_N)));
  CHECK(row_of("PoseReport", "force_sources") ==
        fmt::format("| {} | 1 | bits 4 to 7 | `force_sources` | bits of ForceSource |",
                    offsetof(PoseReport, servo_load) - 1));
  CHECK(row_of("CommandReport", "report_id") == "| 0 | 1 | ReportId | `report_id` | always `ReportId::command` |");
  for (const std::string member : {"selection", "test"})
    CHECK(row_of("CommandReport", member).starts_with(fmt::format("| {} | ", offsetof(CommandReport, test))));
  CHECK(row_of("ScopeFrameHeader", "first_period") ==
        fmt::format("| {} | 4 | uint32 | `first_period` | control period of the first sample, as "
                    "PoseReport::time_periods |",
                    offsetof(ScopeFrameHeader, first_period)));
  for (const std::string line : {"| 4 | select_signals | starts the scope with these signals; none stops it |",
                                 "| 1 | current_int16 | 2 bytes, in steps of `current_step_A` |",
                                 "    A frame is one bulk transfer: a header and"})
    CHECK_MESSAGE(reference.find("\n" + line) != std::string::npos, line);
  CHECK(reference.find(fmt::format("| `scope_magic` | {} |", protocol::scope_magic)) != std::string::npos);
}

TEST_CASE("`watch` shows no position of an unreferenced arm, and its JSON output states the lost reference") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto first_line = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{"watch", "--seconds", "0.05"};
    command.insert(command.end(), more.begin(), more.end());
    auto result = rig.run(command);
    REQUIRE(result.exit_code == 0);
    return result.out;
  };
  const auto is_referenced = [&] {
    const std::string text = first_line({"--json"});
    return nlohmann::json::parse(text.substr(0, text.find('\n'))).at("referenced").get<bool>();
  };
  CHECK(is_referenced());
  CHECK(rig.run({"info"}).out.find("position of the arm known") != std::string::npos);
  CHECK(first_line({}).find("unknown") == std::string::npos);
  // The encoder slips by more than the motion of a joint in one control period.
  rig.control.dock(false);
  rig.control.inject({.fault = "encoder_slip", .of = "1"});
  rig.control.run(0.05);
  rig.control.resume();
  CHECK_FALSE(is_referenced());
  CHECK(rig.run({"info"}).out.find("unknown: put the stylus into the inkwell") != std::string::npos);
  CHECK_FALSE(nlohmann::json::parse(rig.run({"info", "--json"}).out).at("referenced").get<bool>());
  CHECK(first_line({}).find("unknown") != std::string::npos);
}

TEST_CASE("the arms that are there are listed by serial number") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto listed = rig.run({"devices", "--json"});
  REQUIRE(listed.exit_code == 0);
  const auto json = nlohmann::json::parse(listed.out);
  REQUIRE(json.size() == 1);
  CHECK_FALSE(json[0].at("location").get<std::string>().empty());
  CHECK(json[0].at("serial_number") == device::Device::open(*rig.board.find())->information().serial_number);
  CHECK(json[0].at("board") == "omni_driver");
  const auto lines = rig.run({"devices"}).out;
  CHECK(lines.find(" omni_driver ") != std::string::npos);
  CHECK(lines.find(json[0].at("serial_number").get<std::string>()) != std::string::npos);
  CHECK(run_program("inkwell", {"devices", "--virtual"}).exit_code == 2);
}

TEST_CASE("a command switches the force on for as long as it runs, and any other switches it off") {
  BoardAndCompanion rig;
  rig.wait_for_device();
  CHECK(nlohmann::json::parse(rig.run({"force", "--json"}).out).at("force_is_on") == false);
  auto words = rig.words({"force", "on"});
  words.insert(words.begin(), build_directory() + "/inkwell");
  RunningProgram on(words);
  CHECK(on.read_line() == "The force is on.");
  CHECK(on.read_line() == "Ctrl-C switches the force off.");
  CHECK(rig.run({"force"}).out == "The force is on.\n");
  SUBCASE("Ctrl-C") {
    kill(on.process(), SIGINT);
    CHECK(on.read_line() == "The force is off.");
    CHECK(on.wait() == 0);
  }
  SUBCASE("a closed terminal") {
    kill(on.process(), SIGHUP);
    CHECK(on.read_line() == "The force is off.");
    CHECK(on.wait() == 0);
  }
  SUBCASE("another command") {
    const auto off = rig.run({"force", "off"});
    CHECK(off.exit_code == 0);
    CHECK(off.out == "The force is off.\n");
    CHECK(on.wait() == 1);
  }
  SUBCASE("a fault") {
    rig.control.inject({"bridge_fault"});
    CHECK(on.wait() == 1);
    const auto refused = rig.run({"force", "on"});
    CHECK(refused.exit_code == 1);
    CHECK(refused.err.find("The force is off. bridge_fault: A bridge reported") != std::string::npos);
  }
  SUBCASE("its cable, of which the next command hears nothing") {
    rig.control.usb(false);
    CHECK(on.wait() == 1);
    rig.control.usb(true);
    rig.wait_for_device();
    CHECK(rig.run({"force"}).out.starts_with("The force is off. usb_gone: "));
    const auto next = rig.run({"force", "on", "--seconds", "0.1"});
    CHECK_MESSAGE(next.exit_code == 0, next.err);
  }
  CHECK(rig.run({"force"}).out.starts_with("The force is off."));
}

TEST_CASE("the force ends by itself after a time of the board") {
  const auto run = run_program("inkwell", {"--virtual", "force", "on", "--seconds", "0.3"});
  CHECK(run.exit_code == 0);
  CHECK(run.out == "The force is on.\nThe force is off.\n");
}

TEST_CASE("a recording switches the force on if asked to, and off at its end") {
  const TemporaryDirectory directory;
  BoardAndCompanion rig;
  rig.wait_for_device();
  // The target of the hand is 15 mm inside the floor of the box.
  rig.control.run(bring_stylus(rig.control,
                               {0.0, 0.0, protocol::info(protocol::Parameter::box_minimum_z_m).default_value - 0.015},
                               0.6) +
                  0.5);
  rig.control.resume();
  const auto largest_A = [&](const char* file, std::vector<std::string> more) {
    std::vector<std::string> words{"record", directory.file(file), "--seconds", "0.5"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = rig.run(words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    float largest = 0;
    const auto recording = recording::read(directory.file(file));
    for (const float current_A : recording.column(protocol::Signal::current_2_A))
      largest = std::max(largest, std::abs(current_A));
    return largest;
  };
  CHECK(largest_A("without.h5", {}) < 0.05f);  // noise of the converter
  CHECK(largest_A("with.h5", {"--force"}) > 0.2f);
  CHECK(rig.run({"force"}).out == "The force is off.\n");
}

TEST_CASE("a recording that is refused leaves the force off") {
  const TemporaryDirectory directory;
  BoardAndCompanion rig;
  rig.wait_for_device();
  const auto other = device::Device::open(*rig.board.find());
  other->select_signals(std::vector{protocol::Signal::current_1_A});
  const auto refused = rig.run({"record", directory.file("refused.h5"), "--seconds", "0.1", "--force"});
  CHECK(refused.exit_code == 1);
  CHECK(refused.err.find("scope") != std::string::npos);
  CHECK(rig.run({"force"}).out == "The force is off.\n");
}

TEST_CASE("the delay of a program's force is measured, with its frequency response, and does not grow") {
  const auto result = run_program("inkwell", {"measure", "delay", "--virtual", "--recordings", "5", "--json"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto measured = nlohmann::json::parse(result.out);
  CHECK(measured.at("is_simulation") == true);
  CHECK(measured.at("poses_missed") == 0);
  REQUIRE(measured.at("recordings").size() == 5);
  constexpr double period_ms = 1e3 / protocol::servo_rate_Hz;
  const double first_ms = measured.at("recordings")[0].at("shortest_ms");
  CHECK(first_ms > 1.0);
  CHECK(first_ms < 2.5);
  for (const auto& recording : measured.at("recordings"))
    CHECK(std::abs(recording.at("longest_ms").get<double>() - first_ms) <= period_ms);
  REQUIRE(measured.at("responses").size() == 4);
  for (const auto& response : measured.at("responses")) {
    const double frequency_Hz = response.at("frequency_Hz");
    CAPTURE(frequency_Hz);
    const double turns = M_PI * frequency_Hz / 1000, sinc = std::sin(turns) / turns;
    const auto& force = response.at("program_force");
    CHECK(force.at("gain").get<double>() == doctest::Approx(sinc * sinc).scale(0).epsilon(0.03));
    CHECK(force.at("delay_ms").get<double>() == doctest::Approx(first_ms).scale(0).epsilon(0.05));
    CHECK(response.at("current").at("gain").get<double>() > 0.75);
    CHECK(response.at("current").at("gain").get<double>() < 1.05);
    CHECK(response.at("current").at("delay_ms").get<double>() < 0.5);
  }
}
