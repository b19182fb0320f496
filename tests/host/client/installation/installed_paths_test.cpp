// Tests the installed paths for programs in the build folder.
#include <doctest/doctest.h>

#include <filesystem>

#include "host/client/installation/installed_paths.hpp"

using namespace inkwell;

TEST_CASE("a program of a build finds the parts of that build, and no others") {
  const std::filesystem::path build = INKWELL_BUILD_DIRECTORY, source = INKWELL_SOURCE_DIRECTORY;
  CHECK(installation::prefix() == build);
  CHECK(std::filesystem::weakly_canonical(installation::virtual_board()) == build / "virtual-board");
  CHECK(std::filesystem::weakly_canonical(installation::firmware()) == build.parent_path() / "board" / "inkwell.elf");
  CHECK(std::filesystem::weakly_canonical(installation::default_arm()) == source / "boards" / "arms" / "omni.toml");
  CHECK(std::filesystem::weakly_canonical(installation::dropins()) == build / "dropins");
}
