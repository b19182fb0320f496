// Each error message for invalid user input states the problem and the remedy, and the exit code is not 0.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "protocol/parameters.hpp"

#include "tests/system/program.hpp"

using namespace inkwell;
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

/// Occupies a port of this machine during the lifetime of the object.
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
  check_refused(run_program("virtual-board", {"--elf", firmware(), "--usbip", busy.port()}),
                {busy.port().c_str(), "--usbip"});
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

TEST_CASE("the companion refuses invalid commands, options and arguments") {
  SUBCASE("a command follows two dashes") {
    check_refused(run_program("inkwell", {"--", "run", "./program"}), {"--", "Omit it"});
    check_refused(run_program("inkwell", {"--virtual", "--", "info"}), {"--", "Omit it"});
  }
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
  SUBCASE("command") {
    const auto unlike = run_program("inkwell", {"dance"});
    check_refused(unlike, {"no `inkwell dance`", "`inkwell --help`"});
    CHECK(unlike.err.find("Did you mean") == std::string::npos);
    check_refused(run_program("inkwell", {"--virtual", "paramters"}), {"no `inkwell paramters`", "mean parameters?"});
    // The third word of `plot` is not a command, so the error proposes no command.
    check_refused(run_program("inkwell", {"plot", "push.h5", "parameters"}), {"parameters"});
    check_refused(run_program("inkwell", {"--sead", "info"}), {"--sead"});
  }
  SUBCASE("command of a command") {
    check_refused(run_program("inkwell", {"experiment", "hall"}),
                  {"no `inkwell experiment hall`", "inkwell experiment wall"});
    check_refused(run_program("inkwell", {"check", "conection"}), {"mean connection?", "inkwell check "});
    check_refused(run_program("inkwell", {"parameters", "stor"}), {"no `inkwell parameters stor`", "mean store?"});
    check_refused(run_program("inkwell", {"experiment"}), {"inkwell experiment wall"});
  }
  SUBCASE("negative time") {
    const auto result = run_program("inkwell", {"--virtual", "watch", "--seconds", "-1"});
    check_refused(result, {"--seconds", "-1", "more than 0"});
    CHECK(result.err.size() < 200);  // a range up to the largest representable number is not helpful
  }
  SUBCASE("an option or an argument of a command is not a number") {
    const auto program_says = [](const std::string& program, const std::vector<std::string>& words,
                                 const std::string& sentence) {
      const auto result = run_program(program, words);
      CHECK(result.exit_code == 2);
      CHECK(result.err == program + ": " + sentence + "\n");
    };
    const auto says = [&](const std::vector<std::string>& words, const std::string& sentence) {
      program_says("inkwell", words, sentence);
    };
    const auto lab_says = [&](const std::vector<std::string>& words, const std::string& sentence) {
      program_says("inkwell-lab", words, sentence);
    };
    lab_says({"campaign", "run", "17", "abc"},
             "abc is not a number for CASE. Give a number such as 12; `inkwell-lab campaign run --help` describes it.");
    lab_says({"campaign", "run", "-3"},
             "-3 is not valid for CASE. Give a whole number that is not negative, such as 12; "
             "`inkwell-lab campaign run --help` describes it.");
    lab_says({"soak", "--seed", "x"},
             "x is not a number for --seed. Give a number such as 12; `inkwell-lab soak --help` describes it.");
    says({"--virtual", "--seed", "1.5", "info"},
         "1.5 is not valid for --seed. Give a whole number that is not "
         "negative, such as 12; `inkwell --help` describes it.");
    says({"--json=maybe", "info"},
         "--json accepts no value, but got maybe. Omit the value; `inkwell --help` describes it.");
    lab_says({"campaign", "--jobs", "two"}, "--jobs: two is not valid. Give a whole number from 1 to 256.");
    says({"watch", "--rate", "nan"}, "--rate: nan is not valid. Give a number that is from 0.1 to 1000.");
    lab_says({"soak", "--seconds"},
             "The value of --seconds is missing. Give it after the option; `inkwell-lab soak --help` describes it.");
  }
  SUBCASE("layout") {
    check_refused(run_program("inkwell", {"--virtual", "--layout", "nonsense"}), {"nonsense", "--layout", "paper"});
  }
  SUBCASE("options of the window where none opens") {
    check_refused(run_program("inkwell", {"plot", "push.h5", "--layout", "nonsense"}),
                  {"--layout", "`inkwell plot` opens no window"});
    check_refused(run_program("inkwell", {"--parameters", "soft.toml", "record", "push.h5"}),
                  {"--parameters", "`inkwell record` opens no window"});
    // `replay` accepts window options, so the only error is the missing recording.
    const auto replayed = run_program("inkwell", {"replay", "nowhere.h5", "--info", "--layout", "paper"});
    check_refused(replayed, {"nowhere.h5"});
    CHECK(replayed.err.find("--layout") == std::string::npos);
  }
  SUBCASE("kind of picture") {
    const TemporaryDirectory directory;
    const auto file = directory.file("push.csv");
    REQUIRE(run_program("inkwell", {"--virtual", "record", file, "--seconds", "0.1"}).exit_code == 0);
    check_refused(run_program("inkwell", {"plot", file, "--out", directory.file("push.pdf")}), {"push.pdf", ".png"});
    CHECK_FALSE(std::filesystem::exists(directory.file("push.pdf")));
  }
  SUBCASE("empty names of devices, which scripts make") {
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"info", "--usbip", ""}, {"info", "--serial", ""}, {"flash", "--virtual", ""}})
      check_refused(run_program("inkwell", words), {words[1].c_str(), "The value is empty"});
  }
  SUBCASE("ELF") {
    check_refused(run_program("inkwell", {"--virtual", "--elf", "nowhere.elf", "info"}), {"nowhere.elf"});
  }
}

TEST_CASE("a window smaller than its parts need, and two recordings that have no such mark, are refused") {
  check_refused(run_program("inkwell", {"--virtual", "--width", "400"}), {"--width", "900"});
  check_refused(run_program("inkwell", {"--virtual", "--height", "300"}), {"--height", "560"});
  const TemporaryDirectory directory;
  const auto file = directory.file("push.h5");
  REQUIRE(run_program("inkwell", {"--virtual", "record", file, "--seconds", "0.1"}).exit_code == 0);
  check_refused(run_program("inkwell", {"plot", file, "--over", file, "--align", "touch"}),
                {"push has no mark `touch`"});
  check_refused(run_program("inkwell", {"plot", file, "--over", directory.file("none.h5")}), {"none.h5"});
  const auto picture = directory.file("both.png");
  CHECK(
      run_program("inkwell", {"plot", file, "--over", file, "--signals", "current_1_A", "--out", picture}).exit_code ==
      0);
  CHECK(std::filesystem::file_size(picture) > 10'000);
}

TEST_CASE("saving parameters with --json prints the file and the number of parameters") {
  const TemporaryDirectory directory;
  const auto file = directory.file("parameters.toml");
  const auto result = run_program("inkwell", {"--virtual", "parameters", "save", file, "--json"});
  INFO("standard error: ", result.err);
  REQUIRE(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.out);
  CHECK(json.at("file") == file);
  CHECK(json.at("parameters") == protocol::parameter_count);
  CHECK(std::filesystem::file_size(file) > 1000);
}

TEST_CASE("parameters are saved to standard output, and come back from there") {
  const TemporaryDirectory directory;
  const auto result = run_program("inkwell", {"--virtual", "parameters", "save", "-"});
  REQUIRE(result.exit_code == 0);
  const auto file = directory.file("saved.toml");
  write_file(file, result.out);
  CHECK(run_program("inkwell", {"--virtual", "parameters", "load", file}).exit_code == 0);
  CHECK_FALSE(std::filesystem::exists("-"));
}

TEST_CASE("a parameter file of another arm changes the arm only with consent") {
  const TemporaryDirectory directory;
  const auto file = directory.file("omni.toml"), tuning = directory.file("tuning.toml");
  REQUIRE(run_program("inkwell", {"--virtual", "parameters", "save", file}).exit_code == 0);
  const auto paper = (std::filesystem::path(build_directory()) / "../../boards/arms/paper.toml").string();
  const std::vector<std::string> load{"--virtual", "--arm", paper, "--seed", "2", "parameters", "load", file};
  check_refused(run_program("inkwell", load),
                {"was saved from the arm", "This arm is", "omni_driver", "link_2_m", "inkwell_joint_3_rad", "--yes"});
  auto agreed = load;
  agreed.emplace_back("--yes");
  CHECK(run_program("inkwell", agreed).exit_code == 0);

  write_file(tuning, "[parameters]\nwall_stiffness_N_per_m = 600\nbox_minimum_x_m = -0.05\n");
  auto tuned = load;
  tuned.back() = tuning;
  CHECK(run_program("inkwell", tuned).exit_code == 0);
}

TEST_CASE("parameters that were saved are not overwritten unless that is asked for") {
  const TemporaryDirectory directory;
  const auto file = directory.file("calibration.toml");
  write_file(file, "a calibration");
  // The command checks the file before it connects.
  check_refused(run_program("inkwell", {"--usbip", "1", "parameters", "save", file}),
                {"calibration.toml already exists", "--overwrite"});
  CHECK(read_file(file) == "a calibration");
  CHECK(run_program("inkwell", {"--virtual", "parameters", "save", file, "--overwrite"}).exit_code == 0);
  CHECK(read_file(file).find("[parameters]") != std::string::npos);
}

// /dev/full rejects every write, like a full disk.
TEST_CASE("a full disk is reported in a sentence, and no partial file remains") {
  const TemporaryDirectory directory;
  const auto file = directory.file("push.csv");
  REQUIRE(run_program("inkwell", {"--virtual", "record", file, "--seconds", "0.1"}).exit_code == 0);
  std::filesystem::create_symlink("/dev/full", directory.file("full.toml"));
  check_refused(run_program("inkwell", {"--virtual", "parameters", "save", directory.file("full.toml"), "--overwrite"}),
                {"full.toml cannot be written", "free space"});
}

TEST_CASE("without a display or OpenGL 3.3, the window reports the missing requirement") {
  const std::string companion = build_directory() + "/inkwell";
  check_refused(run_program("/usr/bin/env", {"-u", "DISPLAY", "-u", "WAYLAND_DISPLAY", companion}),
                {"No display", "graphical session"});
  check_refused(run_program("/usr/bin/env", {"INKWELL_WINDOW_SYSTEM=mir", companion}),
                {"INKWELL_WINDOW_SYSTEM", "mir", "x11 or wayland"});

  RunningProgram display({"Xvfb", "-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"});
  check_refused(run_program("/usr/bin/env", {"DISPLAY=:" + display.read_line(), "LIBGL_ALWAYS_SOFTWARE=1",
                                             "MESA_GL_VERSION_OVERRIDE=2.1", companion}),
                {"OpenGL 3.3 is needed", "Install"});
}

namespace {

/// Checks the help of a program and of each command. `commands`: all commands of the program.
void check_help(const std::string& program, const std::vector<std::string>& commands) {
  const auto help_of = [&program](const std::string& command) {
    std::vector<std::string> words;
    std::string word;
    for (std::istringstream all(command); all >> word;) words.push_back(word);
    words.push_back("--help");
    const auto result = run_program(program, words);
    INFO(program, " ", command);
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
    return result.out;
  };
  const auto list_of = [](const std::string& help) {
    std::set<std::string> names;
    std::istringstream lines(help.substr(std::min(help.size(), help.find("Subcommands:"))));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line) && !line.empty()) names.insert(line.substr(2, line.find(' ', 2) - 2));
    return names;
  };
  const auto main_help = help_of("");
  CHECK(main_help.find("Exit code") != std::string::npos);
  // The list contains all commands of the program.
  std::set<std::string> listed;
  for (const auto& name : list_of(main_help)) {
    listed.insert(name);
    for (const auto& below : list_of(help_of(name))) listed.insert(name + " " + below);
  }
  for (const auto& name : listed)
    CHECK_MESSAGE(std::ranges::find(commands, name) != commands.end(), "`" << name << "` is missing in the list above");
  for (const auto& command : commands) {
    CAPTURE(command);
    const auto help = help_of(command);
    CHECK(help.find("Usage: " + program + " " + command) != std::string::npos);
    CHECK(help.find("Examples:\n  " + program + " " + command) != std::string::npos);
    for (const char* noise : {"TEXT", "FLOAT", "Excludes", "Needs", "REQUIRED", "required]"})
      CHECK(help.find(noise) == std::string::npos);
    std::string line;
    for (std::istringstream lines(help); std::getline(lines, line);) {
      CAPTURE(line);
      CHECK(line.size() <= 120);
    }
  }
}

}  // namespace

TEST_CASE("every command explains itself") {
  // clang-format off
  const std::vector<std::string> commands{
      "info", "watch", "parameters", "parameters get", "parameters set", "parameters defaults", "parameters load",
      "parameters save", "parameters diff", "parameters arm", "parameters store", "parameters restore",
      "parameters stored", "parameters factory", "experiment", "experiment wall", "calibrate", "tune",
      "tune current-loop", "check", "check connection", "check directions", "measure", "measure delay", "record", "replay", "plot",
      "feel", "mesh", "reference", "signals", "run", "devices", "arms", "arms bind", "arms unbind", "fault",
      "fault clear", "self-test", "force", "force on", "force off",
      "flash"};
  // clang-format on
  check_help("inkwell", commands);
  CHECK(run_program("inkwell", {"--help"}).out.find("--virtual") != std::string::npos);
  check_help("inkwell-lab", {"campaign", "campaign list", "campaign run", "campaign check", "campaign merge", "soak"});
  CHECK(run_program("virtual-board", {"--help"}).out.find("--real-time") != std::string::npos);
}

TEST_CASE("a command that moved to another program reports its new name for all arguments") {
  for (const std::vector<std::string>& words : std::initializer_list<std::vector<std::string>>{
           {"campaign"},
           {"campaign", "--help"},
           {"campaign", "run", "17", "--out", "results"},
           {"--virtual", "--elf", "inkwell.elf", "campaign", "--jobs", "2"}}) {
    const auto result = run_program("inkwell", words);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    CHECK(result.err == "inkwell: `inkwell campaign` is now `inkwell-lab campaign`, in the package inkwell-lab.\n");
  }
  CHECK(run_program("inkwell", {"soak", "--seconds", "3600"}).err ==
        "inkwell: `inkwell soak` is now `inkwell-lab soak`, in the package inkwell-lab.\n");
}
