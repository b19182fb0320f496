// Runs the hardware-independent tests on the virtual board, with the same Cortex-M4F images as in QEMU. Agreement of
// two emulators in 250,000 checks makes a common error unlikely.
#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>

#include "tests/system/program.hpp"

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
    CHECK(result.err.find("the firmware exited with code 0") != std::string::npos);
  }
}

}  // namespace

TEST_CASE("the target's tests pass on the virtual board in fast mode") {
  check_images("fast", {"target-tests-control", "target-tests-link", "target-tests-self-test", "target-tests-usb",
                        "target-tests-requests", "target-tests-streams", "target-tests-poses", "target-tests-hosts",
                        "target-tests-programs"});
}

// The control tests are excluded, because they would run for minutes of board time. The experiment tests the control
// law in exact mode.
TEST_CASE("the target's tests pass on the virtual board in exact mode") {
  check_images("exact", {"target-tests-link", "target-tests-self-test", "target-tests-usb", "target-tests-requests",
                         "target-tests-streams", "target-tests-poses", "target-tests-hosts", "target-tests-programs"});
}
