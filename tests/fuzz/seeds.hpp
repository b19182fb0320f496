// Seeds are typical inputs and all inputs that once caused a failure.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {

struct Seed {
  std::string name;
  Bytes bytes;
};

/// Returns the target's examples, and then the files of the target's folder in the order of their names. A file
/// NAME.hex contains hexadecimal digits with spaces and '#' comments. All other files contain raw bytes. Throws
/// std::runtime_error if a file cannot be read.
std::vector<Seed> seeds_of(const Target& target);

/// Throws std::runtime_error if the file cannot be read.
Bytes contents_of(const std::filesystem::path& file);

}  // namespace inkwell::fuzz
