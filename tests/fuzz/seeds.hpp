// Inputs that are kept: one of each kind, and every one that once broke something.
#pragma once

#include <filesystem>
#include <vector>

#include "target.hpp"

namespace inkwell::fuzz {

struct Seed {
  std::string name;
  Bytes bytes;
};

/// The target's examples, and what lies in its folder, in the order of names: a file NAME.hex holds hexadecimal digits,
/// with spaces and with remarks behind '#'; any other is taken as it is. Throws std::runtime_error if one cannot be
/// read.
std::vector<Seed> seeds_of(const Target& target);

/// Throws std::runtime_error if the file cannot be read.
Bytes contents_of(const std::filesystem::path& file);

}  // namespace inkwell::fuzz
