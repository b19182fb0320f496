// Files that are written in one go.
#pragma once

#include <filesystem>
#include <string_view>

namespace inkwell::recording {

/// Throws device::Error if the text cannot be written whole.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace inkwell::recording
