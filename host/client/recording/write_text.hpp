// Writes or replaces a complete file in one call.
#pragma once

#include <filesystem>
#include <string_view>

namespace inkwell::recording {

/// Throws device::Error if the text cannot be written completely. Then an older file is unchanged.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace inkwell::recording
