// SHA-256 (FIPS 180-4), so that a recording identifies the files that were used.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace inkwell::recording {

/// Returns the digest in 64 hexadecimal digits, as sha256sum prints it.
std::string sha256_of(std::span<const std::byte> content);
/// Returns an empty text if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace inkwell::recording
