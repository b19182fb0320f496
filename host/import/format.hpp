// Formats of objects in files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace inkwell::importer {

enum class Format : std::uint8_t { stl, ply, obj, gltf, vrml };

/// Name of the format for people, for example "STL".
std::string_view name_of(Format format);

/// Name of the format on the command line of inkwell-import, for example "stl".
std::string_view key_of(Format format);
std::optional<Format> parse_format(std::string_view key);

/// All file extensions, for error messages.
inline constexpr std::string_view known_extensions = ".stl, .obj, .ply, .gltf, .glb, .wrl and .wrl.gz";

/// The signature at the start of the file decides. Formats without a signature are known by the extension, in upper or
/// lower case.
std::optional<Format> detect_format(const std::filesystem::path& file, std::span<const std::byte> begin);

}  // namespace inkwell::importer
