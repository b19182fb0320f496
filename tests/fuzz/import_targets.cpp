// Fuzz targets for the import of objects.
#include <stdexcept>

#include "host/geometry/repair.hpp"
#include "host/import/error.hpp"
#include "host/import/pipe_format.hpp"
#include "host/import/readers.hpp"

#include "tests/fuzz/target.hpp"
#include "tests/host/import/made_files.hpp"

namespace inkwell::fuzz {
namespace {

/// Accepted triangles are welded and repaired.
void use(const importer::FileContent& content) {
  importer::check(content, "any");
  std::vector<glm::vec3> vertices_m(content.vertices.begin(), content.vertices.end());
  geometry::Mesh mesh = geometry::weld(vertices_m, content.faces);
  const auto report = geometry::repair(mesh);
  if (!geometry::is_valid(mesh)) throw std::logic_error("a repaired mesh is invalid");
  if (report.measurements.triangles > content.faces.size()) throw std::logic_error("a repair added triangles");
  if (geometry::measure(mesh).closed_parts != report.measurements.closed_parts)
    throw std::logic_error("the measurements of a repaired mesh are wrong");
}

const Registered stl_file{
    "stl_file",
    [](Input input) { refuse_or_take<importer::Error>([&] { use(importer::read_stl(input, "any.stl")); }); },
    [] {
      const auto cube = tests::make_cube();
      return std::vector<Bytes>{bytes_of(tests::binary_stl(cube)), bytes_of(tests::ascii_stl(cube))};
    }};

const Registered ply_file{
    "ply_file",
    [](Input input) { refuse_or_take<importer::Error>([&] { use(importer::read_ply(input, "any.ply")); }); },
    [] {
      return std::vector<Bytes>{
          bytes_of("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nelement tristrips 1\nproperty list int int "
                   "vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n7 0 1 2 3 -1 2 1\n"),
          bytes_of(std::string("ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty char z\r\nproperty "
                               "uchar y\r\nproperty uchar x\r\nelement face 1\r\nproperty list uchar ushort "
                               "vertex_index\r\nend_header\r\n\0\0\0\0\0\1\0\1\0\3\0\0\0\1\0\2",
                               191))};
    }};

const Registered import_message{
    "import_message",
    [](Input input) { refuse_or_take<importer::Error>([&] { use(importer::decode(input, "any.obj")); }); },
    [] {
      const auto cube = tests::make_cube();
      importer::FileContent content{.faces = cube.faces, .unit = importer::Unit::meter, .remarks = {"A remark."}};
      content.vertices.assign(cube.vertices.begin(), cube.vertices.end());
      return std::vector<Bytes>{importer::encode(content), importer::encode_refusal("A sentence.")};
    }};

}  // namespace
}  // namespace inkwell::fuzz
