#include "host/import/format.hpp"

#include <algorithm>
#include <array>

#include "host/client/local/text_file.hpp"

namespace inkwell::importer {
namespace {

struct FormatRow {
  Format format;
  std::string_view key, name;
};

constexpr std::array format_rows{FormatRow{Format::stl, "stl", "STL"}, FormatRow{Format::ply, "ply", "PLY"},
                                 FormatRow{Format::obj, "obj", "OBJ"}, FormatRow{Format::gltf, "gltf", "glTF"},
                                 FormatRow{Format::vrml, "vrml", "VRML"}};

struct ExtensionRow {
  std::string_view extension;
  Format format;
};

constexpr std::array extension_rows{ExtensionRow{".stl", Format::stl},   ExtensionRow{".ply", Format::ply},
                                    ExtensionRow{".obj", Format::obj},   ExtensionRow{".gltf", Format::gltf},
                                    ExtensionRow{".glb", Format::gltf},  ExtensionRow{".wrl", Format::vrml},
                                    ExtensionRow{".vrml", Format::vrml}, ExtensionRow{".wrz", Format::vrml}};

const FormatRow& row_of(Format format) { return *std::ranges::find(format_rows, format, &FormatRow::format); }

}  // namespace

std::string_view name_of(Format format) { return row_of(format).name; }

std::string_view key_of(Format format) { return row_of(format).key; }

std::optional<Format> parse_format(std::string_view key) {
  const auto row = std::ranges::find(format_rows, key, &FormatRow::key);
  return row == format_rows.end() ? std::nullopt : std::optional(row->format);
}

std::optional<Format> detect_format(const std::filesystem::path& file, std::span<const std::byte> begin) {
  const auto text = local::without_byte_order_mark({reinterpret_cast<const char*>(begin.data()), begin.size()});
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Format::ply;
  if (text.starts_with("glTF")) return Format::gltf;
  if (text.starts_with("#VRML") || text.starts_with("#Inventor")) return Format::vrml;
  const bool is_compressed = text.starts_with("\x1F\x8B");
  const auto named = is_compressed && local::has_extension(file, ".gz") ? file.stem() : file;
  for (const ExtensionRow& row : extension_rows)
    if (local::has_extension(named, row.extension))
      return is_compressed && row.format != Format::vrml ? std::nullopt : std::optional(row.format);
  return std::nullopt;
}

}  // namespace inkwell::importer
