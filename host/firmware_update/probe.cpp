#include <firmware_update/probe.hpp>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace inkwell::firmware_update {
namespace {

/// As a word of Tcl, whatever is in it.
std::string tcl_word(const std::string& text) {
  std::string word = "\"";
  for (const char each : text) {
    if (std::strchr("\"\\$[]{};", each) != nullptr) word += '\\';
    word += each;
  }
  return word + "\"";
}

constexpr char cannot_use[] =
    "openocd could not write the firmware: see above. Is the probe connected to SWDIO, SWCLK, NRST and ground, and the "
    "board's power on?";

}  // namespace

std::vector<std::string> openocd_arguments(const std::filesystem::path& image, const std::string& interface) {
  const std::string file = tcl_word(std::filesystem::absolute(image).string());
  // FLASH_OPTCR: BOR_LEV is 0 for level 3; the other bits of the user's byte stay (RM0090, "Option bytes").
  const std::string set_brown_out =
      "set optcr [lindex [read_memory 0x40023c14 32 1] 0]; "
      "if {($optcr & 0x0c) != 0} { stm32f2x options_write 0 [expr {$optcr & 0xe0}] }";
  return {"-f", fmt::format("interface/{}.cfg", interface),
          "-f", "target/stm32f4x.cfg",
          "-c", fmt::format("init; reset halt; flash write_image erase {0}; verify_image {0}", file),
          "-c", set_brown_out,
          "-c", "reset run; shutdown"};
}

void update_by_probe(const Image& image, const std::string& interface, Consent consent) {
  insist(image, {}, consent);
  auto arguments = openocd_arguments(image.file, interface);
  std::vector<char*> words{const_cast<char*>("openocd")};
  for (auto& each : arguments) words.push_back(each.data());
  words.push_back(nullptr);
  pid_t child = 0;
  if (const int result = posix_spawnp(&child, "openocd", nullptr, nullptr, words.data(), environ); result != 0)
    throw device::Error(
        fmt::format("openocd cannot be started: {}. Install it (Debian: the package openocd), or flash over "
                    "USB: inkwell flash.",
                    std::strerror(result)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw device::Error(cannot_use);
}

}  // namespace inkwell::firmware_update
