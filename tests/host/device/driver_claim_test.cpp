// Who drives an arm, in one process: each claim opens the file anew, and so bars the others.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <device/driver_claim.hpp>
#include <device/error.hpp>
#include <failure.hpp>

using namespace inkwell;
using namespace inkwell::tests;
using device::DriverClaim;

namespace {

/// A serial number that no arm and no other run of this test has; its file is gone after the test.
struct SerialNumber {
  std::string text = "test-" + std::to_string(getpid());
  std::filesystem::path file = std::filesystem::temp_directory_path() / ("inkwell-" + text + ".driver");
  SerialNumber() { std::filesystem::remove_all(file); }
  ~SerialNumber() { std::filesystem::remove_all(file); }
};

std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

}  // namespace

TEST_CASE("the second driver of an arm is told who the first is, and may drive when that one ends") {
  const SerialNumber arm;
  const auto open_before = open_files();
  std::optional<DriverClaim> first(std::in_place, arm.text);
  const auto second = [&] { DriverClaim{arm.text}; };
  CHECK(contains(message_of<device::InUse>(second), "(process " + std::to_string(getpid()) + ") drives this arm"));
  CHECK_NOTHROW(DriverClaim(arm.text + "-other"));
  std::filesystem::remove(std::filesystem::temp_directory_path() / ("inkwell-" + arm.text + "-other.driver"));
  first.reset();
  CHECK_NOTHROW(second());
  CHECK(open_files() == open_before);
}

TEST_CASE("the name of a driver that has ended is not left behind that of the next") {
  const SerialNumber arm;
  std::ofstream(arm.file) << std::string(100, '#');
  const DriverClaim claim(arm.text);
  std::string name;
  std::getline(std::ifstream(arm.file), name);
  CHECK(contains(name, "(process "));
  CHECK_FALSE(contains(name, "#"));
}

TEST_CASE("another user may drive the same arm, and a program that the driver starts does not hold it") {
  const SerialNumber arm;
  const auto previous_mask = umask(0077);
  const DriverClaim claim(arm.text);
  umask(previous_mask);
  struct stat status {};
  REQUIRE(stat(arm.file.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0666);
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;  // the directory's own
    if (std::filesystem::read_symlink(entry, gone) != arm.file) continue;
    CHECK((fcntl(std::stoi(entry.path().filename()), F_GETFD) & FD_CLOEXEC) != 0);
    ++found;
  }
  CHECK(found == 1);
}

TEST_CASE("a claim that can not be written down is refused with the file's name") {
  const SerialNumber arm;
  std::filesystem::create_directory(arm.file);
  const auto message = message_of<device::Error>([&] { DriverClaim{arm.text}; });
  CHECK(contains(message, arm.file.string()));
  CHECK(contains(message, "can not be written"));
}
