// Stored inputs: one of each kind, and every input that once broke the code.
#pragma once

#include <filesystem>
#include <vector>

#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {

struct Seed {
  std::string name;
  Bytes bytes;
};

/// The target's examples, then the files of the target's folder, sorted by name. A file NAME.hex contains hexadecimal
/// digits with spaces and '#' comments; other files are raw bytes. Throws std::runtime_error if a file cannot be read.
std::vector<Seed> seeds_of(const Target& target);

/// Throws std::runtime_error if the file cannot be read.
Bytes contents_of(const std::filesystem::path& file);

}  // namespace inkwell::fuzz
