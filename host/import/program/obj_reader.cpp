#include <cmath>
#include <cstdint>
#include <sstream>
#include <string_view>

// The library libtinyobjloader_double stores coordinates in double precision.
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <fmt/format.h>

#include "host/client/local/text_file.hpp"

#include "host/import/error.hpp"
#include "host/import/polygon.hpp"
#include "host/import/program/object_readers.hpp"
#include "host/import/text_scanner.hpp"

namespace inkwell::importer {
namespace {

/// Checks the numbers of vertices and faces, because the library replaces invalid numbers by 0.
void check_line(std::string_view line, std::size_t line_number, const std::string& name) {
  const auto fail = [&](std::string_view problem) {
    throw Error(fmt::format("Line {} of {} has {}. Export the file again.", line_number, name, problem));
  };
  TextScanner words(line);
  const auto key = words.word();
  if (key == "v") {
    for (int axis = 0; axis < 3; ++axis)
      if (const auto number = words.number(); !number || !std::isfinite(*number))
        fail("a vertex without three numbers");
  } else if (key == "f") {
    for (auto word = words.word(); !word.empty(); word = words.word()) {
      const auto number = parse_number(word.substr(0, word.find('/')));
      constexpr double index_max = 1e9;
      if (!number || !(std::abs(*number) <= index_max)) fail("a face with an invalid vertex number");
    }
  }
}

/// Joins lines that end with a backslash, and removes comments. The library takes a comment after a face for corners.
std::string prepared_lines(std::string_view text, const std::string& name) {
  std::string prepared;
  prepared.reserve(text.size() + 1);
  std::string joined;
  TextScanner scanner(text);
  for (std::size_t line_number = 1; !scanner.is_at_end(); ++line_number) {
    std::string_view line = scanner.line();
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    if (line.ends_with('\\')) {
      joined.append(line.substr(0, line.size() - 1)).push_back(' ');
      continue;
    }
    joined.append(line);
    const auto whole = std::string_view(joined).substr(0, joined.find('#'));
    check_line(whole, line_number, name);
    prepared.append(whole).push_back('\n');
    joined.clear();
  }
  return prepared;
}

class ObjContent {
 public:
  explicit ObjContent(const std::string& name) : name_(name) {}

  void add_vertex(const glm::dvec3& vertex) {
    content.vertices.push_back(vertex);
    check_counts(content.vertices.size(), 0, name_);
  }

  /// A positive index counts from the first vertex of the file, and a negative index from the latest vertex.
  void add_face(std::span<const tinyobj::index_t> corners) {
    if (corners.size() > corners_max)
      throw Error(
          fmt::format("{} has a face with more than {} corners. Split the face in a mesh editor.", name_, corners_max));
    corners_.clear();
    const auto count = static_cast<std::int64_t>(content.vertices.size());
    for (const tinyobj::index_t& corner : corners) {
      const std::int64_t index = corner.vertex_index < 0 ? count + corner.vertex_index : corner.vertex_index - 1;
      if (index < 0 || index >= count)
        throw Error(
            fmt::format("{} has a face that refers to vertex {}, but only {} vertices precede the face. Export "
                        "the file again.",
                        name_, corner.vertex_index, count));
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    append_triangles(content.vertices, corners_, content.faces);
    check_counts(0, content.faces.size(), name_);
  }

  FileContent content{};

 private:
  const std::string& name_;
  std::vector<std::uint32_t> corners_{};
};

}  // namespace

FileContent read_obj(const std::filesystem::path& file, const std::string& name) {
  const auto bytes = read_file(file, name);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::istringstream lines(prepared_lines(local::without_byte_order_mark(text), name));
  ObjContent object(name);
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* user_data, double x, double y, double z, double) {
    static_cast<ObjContent*>(user_data)->add_vertex({x, y, z});
  };
  callbacks.index_cb = [](void* user_data, tinyobj::index_t* corners, int count) {
    static_cast<ObjContent*>(user_data)->add_face({corners, static_cast<std::size_t>(count)});
  };
  std::string warning, error;
  if (!tinyobj::LoadObjWithCallback(lines, callbacks, &object, nullptr, &warning, &error))
    throw Error(fmt::format("{} is not a valid OBJ file: {} Export the file again.", name, error));
  return std::move(object.content);
}

}  // namespace inkwell::importer
