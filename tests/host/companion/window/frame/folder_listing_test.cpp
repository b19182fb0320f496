// Tests the entries of the file chooser, and the messages for file system errors.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include <doctest/doctest.h>
#include <unistd.h>
#include "tests/temporary_directory.hpp"

#include "host/companion/window/frame/folder_listing.hpp"

using namespace inkwell::window;
using inkwell::tests::TemporaryDirectory;
namespace fs = std::filesystem;

namespace {
const std::vector<std::string> toml{".toml"};

void write(const std::string& file, const std::string& content) { std::ofstream(file) << content; }
}  // namespace

TEST_CASE("a folder is listed with its folders first, and only with the files that are meant") {
  const TemporaryDirectory directory;
  write(directory.file("b.toml"), "12345");
  write(directory.file("a.toml"), "");
  write(directory.file("notes.txt"), "");
  write(directory.file(".hidden.toml"), "");
  fs::create_directory(directory.file("z"));
  const fs::path folder = fs::path(directory.file("x")).parent_path();

  const FolderListing listing = list_folder(folder, toml);
  CHECK(listing.problem.empty());
  REQUIRE(listing.entries.size() == 3);
  CHECK(listing.entries[0].name == "z");
  CHECK(listing.entries[0].is_folder);
  CHECK(listing.entries[1].name == "a.toml");
  CHECK(listing.entries[2].bytes == 5);
  CHECK(std::abs(static_cast<double>(listing.entries[2].changed - std::time(nullptr))) < 60);
  CHECK(list_folder(folder, {}).entries.size() == 4);
}

TEST_CASE("a file or folder that cannot be listed, read or written is reported with the reason") {
  const TemporaryDirectory directory;
  const fs::path file = directory.file("a.toml");
  write(file, "");
  CHECK(list_folder(directory.file("nowhere"), toml).problem.find("The folder") == 0);
  CHECK(list_folder(file, toml).problem.find("is a file") != std::string::npos);
  CHECK(reading_problem(file).empty());
  CHECK(reading_problem(directory.file("b.toml")).find("The file") == 0);
  CHECK(reading_problem(file.parent_path()).find("is a folder") != std::string::npos);
  CHECK(writing_problem(file).empty());
  CHECK(writing_problem(directory.file("nowhere") + "/a.toml").find("The folder") == 0);
  CHECK(writing_problem(file.parent_path()).find("is a folder") != std::string::npos);
  if (geteuid() == 0) return;  // root has access to every folder
  fs::permissions(file, fs::perms::none);
  CHECK(reading_problem(file).find("You have no permission to read") == 0);
  CHECK(writing_problem(file).find("You have no permission to write") == 0);
}

TEST_CASE("typed names are relative to the folder, absolute, or in the user's home") {
  CHECK(typed_path("/some/folder", "soft.toml") == "/some/folder/soft.toml");
  CHECK(typed_path("/some/folder", "../soft.toml") == "/some/soft.toml");
  CHECK(typed_path("/some/folder", "/other/soft.toml") == "/other/soft.toml");
  if (const char* home = std::getenv("HOME"))
    CHECK(typed_path("/some/folder", "~/soft.toml") == (fs::path(home) / "soft.toml").lexically_normal());
  CHECK(with_ending("soft", toml) == "soft.toml");
  CHECK(with_ending("soft.toml", toml) == "soft.toml");
  CHECK(with_ending("SOFT.TOML", toml) == "SOFT.TOML");
  CHECK(with_ending("v1.2", toml) == "v1.2.toml");
}

TEST_CASE("sizes are short") {
  CHECK(size_text(999) == "999 B");
  CHECK(size_text(1'500) == "1.5 kB");
  CHECK(size_text(2'340'000) == "2.3 MB");
  CHECK(size_text(5'000'000'000) == "5.0 GB");
}
