// Each command of each interface is followed by each kind of program exit. A command that has returned must have been
// executed.
#include <doctest/doctest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <inkwell/inkwell.hpp>
#include "tests/system/program.hpp"

#include "tests/library/virtual_arm.hpp"

namespace inkwell::tests {
namespace {

using Words = std::vector<std::string>;

struct Interface {
  std::string name;
  Words words, commands, endings;
};

const Words everything{"stop", "disable", "clear", "set", "store", "shapes"},
    without_shapes{"stop", "disable", "clear", "set", "store"};
const Words every_end{"close", "exit", "kill", "unplug"};

/// Returns the interfaces with their commands and kinds of exit. A command of the command line or the window is
/// complete when its program exits.
std::vector<Interface> interfaces() {
  const std::string build = build_directory(), programs = INKWELL_SOURCE_DIRECTORY "/tests/library/programs/";
  std::vector<Interface> all{
      {"C", {build + "/library-ending", "c"}, everything, every_end},
      {"C++", {build + "/library-ending", "cpp"}, everything, every_end},
      {"command line", {INKWELL_PYTHON, programs + "command_ending.py", build}, without_shapes, {"exit", "unplug"}},
      {"window", {build + "/window-ending"}, without_shapes, {"exit", "unplug"}}};
#ifndef __SANITIZE_ADDRESS__  // interpreters without the sanitizer cannot load libraries that use it
  all.push_back({"Python", {INKWELL_PYTHON, programs + "ending.py"}, everything, every_end});
  const auto add_dropin = [&](const std::string& name, Words commands) {
    const Words words{INKWELL_PYTHON, programs + "dropin_ending.py", build, name};
    all.push_back({name, words, std::move(commands), {"exit", "kill", "unplug"}});
  };
  add_dropin("hdapi", {"disable", "stop_scheduler", "close_device"});
  add_dropin("hdphantom", {"stop_scheduler", "close_device"});
#ifdef INKWELL_OCTAVE
  all.push_back({"Octave",
                 {INKWELL_OCTAVE, "--norc", "--quiet", "--path", build + "/octave", programs + "ending.m"},
                 without_shapes,
                 every_end});
#endif
#endif
  return all;
}

/// A board with the stylus outside the inkwell. A second arm object observes the board.
struct Watched : Board {
  VirtualArm watcher{address};
  std::optional<VirtualArm> driver;  ///< the arm whose force is stopped

  Watched() {
    watcher.be_patient();
    watcher.wait_until([](const auto& pose) { return pose.state == INKWELL_READY; });
    hold();
    watcher.wait_until([](const auto& pose) { return pose.in_inkwell == 0; });
  }

  /// Returns the next pose. If the cable is disconnected, waits until it is connected again.
  inkwell_pose newest() {
    inkwell_pose pose;
    for (int i = 0; i < 6'000; ++i) {
      if (inkwell_wait_for_pose(watcher.arm, 10, &pose) == INKWELL_OK) return pose;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL("the board does not come back");
    return {};
  }
  /// Returns after the watcher has detected the disconnection.
  void pull_cable() {
    control.usb(false);
    inkwell_pose pose;
    while (inkwell_get_pose(watcher.arm, &pose) == INKWELL_OK)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  /// Repeats a call of the watcher while poses are missing. Poses can be missing after a cable was unplugged or on a
  /// busy computer.
  template <class Call>
  void require(Call call) {
    auto result = INKWELL_DISCONNECTED;
    for (int i = 0; i < 6'000 && result == INKWELL_DISCONNECTED; ++i) {
      if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      result = call(watcher.arm);
    }
    REQUIRE_MESSAGE(result == INKWELL_OK, std::string(inkwell_error_text()));
  }
  double stiffness_N_per_m() {
    double value = 0;
    require([&](inkwell_arm* arm) { return inkwell_get_parameter(arm, "wall_stiffness_N_per_m", &value); });
    return value;
  }

  void prepare(const std::string& command) {
    if (command == "clear") {
      control.inject({"bridge_fault"});
      for (int i = 0; newest().state != INKWELL_FAULT; ++i) REQUIRE(i < 6'000);
      control.heal("bridge_fault");
    } else if (command == "stop") {
      driver.emplace(address);
      REQUIRE_MESSAGE(inkwell_enable_force(driver->arm, 30) == INKWELL_OK, std::string(inkwell_error_text()));
    } else if (command == "set") {
      const char* const name = "wall_stiffness_N_per_m";
      const double value = 500;
      require([&](inkwell_arm* arm) { return inkwell_set_parameters(arm, &name, &value, 1); });
    } else if (command == "store") {
      require(inkwell_factory_reset);
      require(set_patience);
    }
  }
  /// Checks the effect of the command. The program must not leave any state on the board except the effect of the
  /// command.
  void check(const std::string& command) {
    // The first received poses may be older than the command.
    for (int i = 0; i < 1'000 && newest().state != INKWELL_READY; ++i) continue;
    CHECK(newest().state == INKWELL_READY);
    driver.reset();
    if (command == "set") CHECK(stiffness_N_per_m() == 777);
    if (command == "store") {
      inkwell_store store{};
      require([&](inkwell_arm* arm) { return inkwell_get_store(arm, &store); });
      CHECK(store.contents == INKWELL_STORED_PARAMETERS);
    }
    inkwell_driver left{.is_driven = 1};
    for (int i = 0; i < 6'000 && left.is_driven != 0; ++i) {
      require([&](inkwell_arm* arm) { return inkwell_get_driver(arm, &left); });
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CHECK(left.is_driven == 0);
  }
};

void play(Watched& board, const Interface& interface, const std::string& command, const std::string& ending) {
  CAPTURE(interface.name);
  CAPTURE(command);
  CAPTURE(ending);
  board.prepare(command);
  const bool unplugs = ending == "unplug";
  auto words = interface.words;
  words.push_back(command);
  words.push_back(unplugs ? "wait" : ending);
  RunningProgram program(words, {"PYTHONPATH=" INKWELL_BUILD_DIRECTORY "/python"});
  CHECK(program.read_line() == "returned");
  if (unplugs) {
    board.pull_cable();
    board.control.usb(true);
  } else {
    program.wait();
  }
  board.check(command);
}

TEST_CASE("a command that has returned has happened, however its program ends") {
  Watched board;
  for (const auto& interface : interfaces())
    for (const auto& command : interface.commands)
      for (const auto& ending : interface.endings) play(board, interface, command, ending);
}

TEST_CASE("a program drives the arm at its first try after one that was killed") {
  Watched board;
  RunningProgram program({build_directory() + "/library-ending", "c", "shapes", "kill"});
  REQUIRE(program.read_line() == "returned");
  program.wait();
  inkwell_driver driver{};
  REQUIRE(inkwell_get_driver(board.watcher.arm, &driver) == INKWELL_OK);
  CHECK(driver.is_driven == 1);
  CHECK_MESSAGE(inkwell_enable_force(board.watcher.arm, 30) == INKWELL_OK, std::string(inkwell_error_text()));
}

TEST_CASE("a command that the board can not confirm any more is an error") {
  Watched board;
  board.pull_cable();
  for (auto* const command : {inkwell_stop, inkwell_disable_force, inkwell_clear_fault, inkwell_store_parameters,
                              inkwell_factory_reset, inkwell_take_over}) {
    CHECK(command(board.watcher.arm) == INKWELL_DISCONNECTED);
    CHECK_FALSE(std::string(inkwell_error_text()).empty());
  }
}

}  // namespace
}  // namespace inkwell::tests
