// The pure tests, compiled for the Cortex-M4F, on the virtual board: the images that QEMU runs, unchanged. Two
// emulators that agree on a quarter of a million checks are more likely to be right than one.
#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "program.hpp"

using namespace inkwell::tests;

namespace {

void check_images(const std::string& mode, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const std::string image = build_directory() + "/../board/" + name + ".elf";
    const auto result = run_program("virtual-board", {"--elf", image, "--mode", mode});
    const std::size_t shown = std::min<std::size_t>(result.err.size(), 2000);
    INFO(name, " in ", mode, " mode, the end of its log: ", result.err.substr(result.err.size() - shown));
    CHECK(result.exit_code == 0);
    CHECK(result.err.find("Status: SUCCESS!") != std::string::npos);
    CHECK(result.err.find("the firmware ended with exit code 0") != std::string::npos);
  }
}

}  // namespace

TEST_CASE("the target's tests pass on the virtual board in fast mode") {
  check_images("fast", {"target-tests-control", "target-tests-link", "target-tests-self-test", "target-tests-usb",
                        "target-tests-requests", "target-tests-streams", "target-tests-poses"});
}

// Without those of the control law, which run for minutes of board time: exact mode is the one that the experiment,
// with the same law, runs in.
TEST_CASE("the target's tests pass on the virtual board in exact mode") {
  check_images("exact", {"target-tests-link", "target-tests-self-test", "target-tests-usb", "target-tests-requests",
                         "target-tests-streams", "target-tests-poses"});
}
