// Import of whole files, also through the helper program: formats, units, remarks and refusals.
#include <doctest/doctest.h>

#include <sys/stat.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/import/import.hpp"
#include "tests/failure.hpp"
#include "tests/host/import/made_files.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::tests;
using importer::import_object;
using importer::Object;

namespace {

class Folder {
 public:
  std::filesystem::path write(const std::string& name, std::string_view content) const {
    const auto file = directory_ / name;
    write_file(file, content);
    return file;
  }
  Object import(const std::string& name, std::string_view content, const importer::ImportOptions& options = {}) const {
    return import_object(write(name, content), options);
  }
  std::string refusal(const std::string& name, std::string_view content) const {
    return message_of<importer::Error>([&] { import(name, content); });
  }
  std::filesystem::path operator/(const std::string& name) const { return directory_ / name; }

 private:
  TemporaryDirectory directory_;
};

/// A closed, outward cube of this side, without flipped triangles in the file.
void check_cube(const Object& object, double side_m, std::size_t triangles = 12) {
  const auto& [measured, repairs] = object.report;
  CHECK(measured.triangles == triangles);
  CHECK(measured.is_closed());
  CHECK(measured.volume_m3 == doctest::Approx(side_m * side_m * side_m).scale(0));
  CHECK(repairs.turned == 0);
  CHECK(repairs.turned_parts == 0);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(measured.box.maximum_m[axis] == doctest::Approx(0.5 * side_m).scale(0));
    CHECK(measured.box.minimum_m[axis] == doctest::Approx(-0.5 * side_m).scale(0));
  }
}

bool has_remark(const Object& object, std::string_view words) {
  return std::ranges::any_of(object.remarks, [&](const std::string& remark) { return contains(remark, words); });
}

std::string cube_obj(const std::string& line_end = "\n") {
  const Cube cube = make_cube(20);
  std::string text = "# a cube" + line_end + "mtllib missing.mtl" + line_end;
  for (const auto& vertex : cube.vertices) text += fmt::format("v {} {} {}{}", vertex.x, vertex.y, vertex.z, line_end);
  text += "usemtl steel" + line_end + "o first body" + line_end;
  for (const auto& face : cube.faces)
    text += fmt::format("f {}/1/1 {}//2 {} # a comment{}", face[0] + 1, face[1] + 1, face[2] + 1, line_end);
  return text;
}

// ---- glTF

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j)
      bits = bits << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j) text += i + j <= bytes.size() ? digits[bits >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

/// The parts of a glTF file with a cube of 20 units.
struct Gltf {
  std::string buffer{};
  std::string positions = R"({"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"})";
  std::string indices = R"({"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"})";
  std::string views{};
  std::string node = R"({"mesh": 0, "scale": [0.001, 0.001, 0.001]})";
  std::string more_nodes{};
  std::string scene_nodes = "0";
  std::string more{};
  std::string mode{};
  std::string more_accessors{};

  std::string json(const std::string& uri) const {
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, {} "scene": 0, "scenes": [{{"nodes": [{}]}}], "nodes": [{}{}],
 "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1{}}}]}}], "accessors": [{}, {}{}],
 "bufferViews": [{}], "buffers": [{{{} "byteLength": {}}}]}})",
        more, scene_nodes, node, more_nodes, mode, positions, indices, more_accessors, views,
        uri.empty() ? "" : fmt::format(R"("uri": "{}",)", uri), buffer.size());
  }
  std::string with_data_uri() const { return json("data:application/octet-stream;base64," + base64(buffer)); }
  std::string glb() const {
    std::string text = json("");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string data = buffer;
    data.resize((data.size() + 3) / 4 * 4, '\0');
    ByteText bytes;
    bytes.text = "glTF";
    bytes.add(2u).add(static_cast<std::uint32_t>(28 + text.size() + data.size()));
    bytes.add(static_cast<std::uint32_t>(text.size())).text += "JSON" + text;
    bytes.add(static_cast<std::uint32_t>(data.size())).text += std::string("BIN\0", 4) + data;
    return bytes.text;
  }
};

std::string view(std::size_t offset, std::size_t length, const std::string& more = "") {
  return fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}{}}})", offset, length, more);
}

std::string index_bytes(const Cube& cube) {
  ByteText bytes;
  for (const auto& face : cube.faces)
    for (const auto vertex : face) bytes.add(static_cast<std::uint16_t>(vertex));
  return bytes.text;
}

template <class Coordinate = float>
std::string position_bytes(const Cube& cube, std::size_t padding = 0) {
  ByteText bytes;
  for (const auto& vertex : cube.vertices) {
    for (int axis = 0; axis < 3; ++axis) bytes.add(static_cast<Coordinate>(vertex[axis]));
    for (std::size_t i = 0; i < padding; ++i) bytes.add(std::uint8_t{0xFF});
  }
  return bytes.text;
}

Gltf cube_gltf() {
  const Cube cube = make_cube(20);
  Gltf gltf;
  const auto positions = position_bytes(cube), indices = index_bytes(cube);
  gltf.buffer = positions + indices;
  gltf.views = view(0, positions.size()) + ", " + view(positions.size(), indices.size());
  return gltf;
}

// ---- VRML

std::string face_set(const std::string& fields = "") {
  const Cube cube = make_cube(20);
  std::string text = "Shape { geometry IndexedFaceSet { " + fields + " coord Coordinate { point [";
  for (const auto& vertex : cube.vertices) text += fmt::format("{} {} {}, ", vertex.x, vertex.y, vertex.z);
  text += "] } coordIndex [";
  for (const auto& face : cube.faces) text += fmt::format("{},{},{},-1,", face[0], face[1], face[2]);
  return text + "] } }\n";
}

std::string vrml(const std::string& scene) { return "#VRML V2.0 utf8\n" + scene; }

}  // namespace

TEST_CASE("STL and PLY files are imported, with the unit from the user or a proposed one") {
  const Folder folder;
  const auto proposed = folder.import("cube.stl", binary_stl(make_cube(20)));
  check_cube(proposed, 0.02);
  CHECK(proposed.unit == importer::Unit::millimeter);
  CHECK(proposed.unit_source == importer::UnitSource::proposal);
  CHECK(has_remark(proposed, "The program assumes mm, so the object is 20 mm long"));
  CHECK(proposed.middle_m.x == doctest::Approx(0.01));
  const auto inches = folder.import("CUBE.STL", ascii_stl(make_cube(20)), {.unit = importer::Unit::inch, .scale = 0.5});
  check_cube(inches, 0.254);
  CHECK(inches.unit_source == importer::UnitSource::user);
  CHECK(inches.remarks.empty());
}

TEST_CASE("an object far from the origin keeps its shape") {
  const Folder folder;
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  const Cube cube = make_cube(20);
  for (const auto& vertex : cube.vertices)
    text += fmt::format("{} {} {}\n", 4e8 + vertex.x, 5e8 + vertex.y, 6e8 + vertex.z);
  for (const auto& face : cube.faces) text += fmt::format("3 {} {} {}\n", face[0], face[1], face[2]);
  const auto object = folder.import("far.ply", text, {.unit = importer::Unit::millimeter});
  check_cube(object, 0.02);
  CHECK(object.middle_m.y == doctest::Approx(500'000.01).epsilon(1e-12));
}

TEST_CASE("repairs and open meshes are reported") {
  const Folder folder;
  Cube cube = make_cube(20);
  std::swap(cube.faces[4][0], cube.faces[4][1]);
  cube.faces.push_back({0, 0, 1});
  const auto repaired = folder.import("cube.stl", binary_stl(cube));
  CHECK(has_remark(repaired, "1 flipped triangle was turned."));
  CHECK(has_remark(repaired, "1 triangle was removed, because it has no area."));
  CHECK(repaired.report.measurements.is_closed());
  Cube open = make_cube(20);
  open.faces.pop_back();
  CHECK(has_remark(folder.import("open.stl", binary_stl(open)),
                   "The mesh is open at 3 edges. It is a surface with two sides"));
}

TEST_CASE("OBJ files are imported: comments, line ends, relative indices, continued lines and polygons") {
  const Folder folder;
  check_cube(folder.import("cube.obj", "\xEF\xBB\xBF" + cube_obj()), 0.02);
  check_cube(folder.import("cube.OBJ", cube_obj("\r\n")), 0.02);
  const auto object =
      folder.import("relative.obj",
                    "v 0 0 \\\n 0\nv 20 0 0\nv 20 20 0 1.0\nv 0 20 0 0.5 0.5 0.5\nf -4 -3 \\\r\n -2 -1\n"
                    "v 20 5e0 1.0E+1\nf 1 2 5\ncurv 0 1 1 2\n");
  CHECK(object.report.measurements.triangles == 3);
  CHECK(object.report.measurements.area_m2 == doctest::Approx(4e-4 + 0.5 * 0.02 * std::hypot(0.005, 0.01)).scale(0));
}

TEST_CASE("an invalid OBJ file is refused with a sentence") {
  const Folder folder;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK(contains(folder.refusal("a.obj", points), "contains no triangles"));
  CHECK(contains(folder.refusal("a.obj", points + "f 1 2 4\n"), "refers to vertex 4, but only 3 vertices"));
  CHECK(contains(folder.refusal("a.obj", points + "f 1 2 -4\n"), "refers to vertex -4"));
  CHECK(contains(folder.refusal("a.obj", points + "f 0 1 2\n"), "refers to vertex 0"));
  CHECK(contains(folder.refusal("a.obj", points + "f 1 2 99999999999999999999\n"), "invalid vertex number"));
  CHECK(
      contains(folder.refusal("a.obj", "v 0 zero 0\n" + points), "Line 1 of a.obj has a vertex without three numbers"));
  CHECK(contains(folder.refusal("a.obj", "v 0 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "Line 1 of a.obj"));
  CHECK(contains(folder.refusal("a.obj", std::string(1000, '\0')), "a.obj"));
}

TEST_CASE("glTF files are imported in meters, from a data URI, a separate file and a GLB") {
  const Folder folder;
  const Gltf gltf = cube_gltf();
  const auto object = folder.import("cube.gltf", gltf.with_data_uri());
  check_cube(object, 0.02);
  CHECK(object.unit == importer::Unit::meter);
  CHECK(object.unit_source == importer::UnitSource::file);
  check_cube(folder.import("cube.glb", gltf.glb()), 0.02);
  folder.write("cube data.bin", gltf.buffer);
  check_cube(folder.import("separate.gltf", gltf.json("cube%20data.bin")), 0.02);
}

TEST_CASE("mirrored and nested nodes of a glTF file keep the outside outside") {
  const Folder folder;
  Gltf gltf = cube_gltf();
  gltf.node = R"({"children": [1, 2], "scale": [-0.001, 0.001, 0.001]})";
  gltf.more_nodes =
      R"(, {"mesh": 0, "translation": [100, 0, 0]}, {"mesh": 0, "matrix": [1,0,0,0, 0,-1,0,0, 0,0,1,0, 0,0,0,1]}, {"mesh": 0})";
  const auto object = folder.import("mirrored.gltf", gltf.with_data_uri());
  CHECK(object.report.measurements.parts == 2);  // the last node is not in the scene
  CHECK(object.report.measurements.closed_parts == 2);
  CHECK(object.report.repairs.turned_parts == 0);
  CHECK(object.report.measurements.volume_m3 == doctest::Approx(2 * 8e-6).scale(0));
}

TEST_CASE("interleaved, sparse and quantized accessors of a glTF file are read") {
  const Folder folder;
  const Cube cube = make_cube(20);
  const auto indices = index_bytes(cube);
  SUBCASE("interleaved") {
    Gltf gltf;
    const auto positions = "1234" + position_bytes(cube, 8);
    gltf.buffer = positions + indices;
    gltf.views = view(0, positions.size(), R"(, "byteStride": 20)") + ", " + view(positions.size(), indices.size());
    gltf.positions = R"({"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 8, "type": "VEC3"})";
    check_cube(folder.import("a.gltf", gltf.with_data_uri()), 0.02);
  }
  SUBCASE("sparse, with and without a base") {
    for (const bool has_base : {false, true}) {
      Cube base = cube;
      base.vertices[7] = {};
      const auto positions = position_bytes(base);
      ByteText sparse;
      for (std::uint16_t i = 0; i < 8; ++i) sparse.add(i);
      Gltf gltf;
      gltf.buffer = positions + indices + sparse.text + position_bytes(cube);
      const std::size_t first = positions.size() + indices.size();
      gltf.views = view(0, positions.size()) + ", " + view(positions.size(), indices.size()) + ", " + view(first, 16) +
                   ", " + view(first + 16, 96);
      const int from = has_base ? 7 : 0;
      gltf.positions = fmt::format(
          R"({{{} "componentType": 5126, "count": 8, "type": "VEC3", "sparse": {{"count": {}, "indices": {{"bufferView": 2,
          "byteOffset": {}, "componentType": 5123}}, "values": {{"bufferView": 3, "byteOffset": {}}}}}}})",
          has_base ? R"("bufferView": 0,)" : "", 8 - from, 2 * from, 12 * from);
      check_cube(folder.import("a.gltf", gltf.with_data_uri()), 0.02);
    }
  }
  SUBCASE("quantized") {
    Gltf gltf;
    Cube largest = make_cube(32767);
    const auto positions = position_bytes<std::int16_t>(largest, 2);
    gltf.buffer = positions + indices;
    gltf.views = view(0, positions.size(), R"(, "byteStride": 8)") + ", " + view(positions.size(), indices.size());
    gltf.positions = R"({"bufferView": 0, "componentType": 5122, "normalized": true, "count": 8, "type": "VEC3"})";
    gltf.more = R"("extensionsRequired": ["KHR_mesh_quantization"], "extensionsUsed": ["KHR_mesh_quantization"],)";
    gltf.node = R"({"mesh": 0, "scale": [0.02, 0.02, 0.02]})";
    check_cube(folder.import("a.glb", gltf.glb()), 0.02);
  }
}

TEST_CASE("strips and fans of a glTF file have one orientation") {
  const Folder folder;
  Gltf gltf;
  ByteText positions, indices;
  for (const glm::vec3& vertex : {glm::vec3(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})
    for (int axis = 0; axis < 3; ++axis) positions.add(vertex[axis]);
  for (const std::uint8_t index : {0, 1, 2, 3}) indices.add(index);
  gltf.buffer = positions.text + indices.text;
  gltf.views = view(0, 48) + ", " + view(48, 4);
  gltf.positions = R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"})";
  gltf.indices = R"({"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"})";
  gltf.mode = R"(, "mode": 5)";
  const auto strip = folder.import("a.gltf", gltf.with_data_uri());
  CHECK(strip.report.measurements.triangles == 2);
  CHECK(strip.report.repairs.turned == 0);
  gltf.mode = R"(, "mode": 6)";
  const auto fan = folder.import("a.gltf", gltf.with_data_uri());
  CHECK(fan.report.measurements.triangles == 2);
  gltf.mode = R"(, "mode": 1)";
  CHECK(contains(folder.refusal("a.gltf", gltf.with_data_uri()), "contains no triangles"));
}

TEST_CASE("an unknown required extension of a glTF file is refused by its name") {
  const Folder folder;
  for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"}) {
    Gltf gltf = cube_gltf();
    gltf.more = fmt::format(R"("extensionsRequired": ["{}"],)", extension);
    CHECK(contains(folder.refusal("a.gltf", gltf.with_data_uri()),
                   fmt::format("requires the glTF extension {},", extension)));
    CHECK(contains(folder.refusal("a.glb", gltf.glb()), extension));
  }
  Gltf gltf = cube_gltf();
  gltf.more = R"("extensionsRequired": ["KHR_materials_unlit", "KHR_texture_transform"],)";
  check_cube(folder.import("a.gltf", gltf.with_data_uri()), 0.02);
}

TEST_CASE("an invalid glTF file is refused with a sentence") {
  const Folder folder;
  const Gltf good = cube_gltf();
  const auto glb = good.glb();
  for (const std::size_t size : {4u, 10u, 19u, 30u, 200u})
    CHECK(contains(folder.refusal("a.glb", glb.substr(0, size)), "a.glb"));
  CHECK(contains(folder.refusal("a.glb", glb.substr(0, glb.size() - 100)), "a.glb"));
  CHECK(contains(folder.refusal("a.gltf", "{"), "valid JSON"));
  CHECK(contains(folder.refusal("a.gltf", R"({"asset": {"version": "1.0"}})"), "another version of glTF than 2"));
  auto old = glb;
  old[4] = 1;
  CHECK(contains(folder.refusal("a.glb", old), "another version of glTF than 2"));
  CHECK(contains(folder.refusal("a.gltf", good.json("none.bin")), "none.bin"));
  CHECK(contains(folder.refusal("a.gltf", good.json("/dev/zero")), "a.gltf"));
  const auto broken = [&](const auto& change) {
    Gltf gltf = good;
    change(gltf);
    return folder.refusal("a.gltf", gltf.with_data_uri());
  };
  CHECK(contains(broken([](Gltf& gltf) { gltf.scene_nodes = "7"; }), "a.gltf"));
  CHECK(contains(broken([](Gltf& gltf) { gltf.node = R"({"mesh": 4})"; }), "mesh that does not exist"));
  CHECK(contains(broken([](Gltf& gltf) { gltf.node = R"({"children": [0]})"; }), "two parents"));
  CHECK(contains(broken([](Gltf& gltf) {
                   gltf.positions = R"({"bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3"})";
                 }),
                 "accessor without its data"));
  CHECK(contains(broken([](Gltf& gltf) {
                   gltf.positions = R"({"bufferView": 0, "componentType": 5126, "count": 4000000000, "type": "VEC3"})";
                 }),
                 "more than 5 million triangles"));
  CHECK(contains(broken([](Gltf& gltf) {
                   gltf.positions = R"({"bufferView": 0, "componentType": 5126, "count": 7, "type": "VEC3"})";
                 }),
                 "refers to vertex 7"));
}

TEST_CASE("VRML files are imported: transforms, DEF and USE, Inline, ccw FALSE and compression") {
  const Folder folder;
  const importer::ImportOptions in_mm{.unit = importer::Unit::millimeter};
  check_cube(folder.import("cube.wrl", vrml(face_set()), in_mm), 0.02);
  check_cube(folder.import("mirrored.wrl", vrml("Transform { scale -1 1 1 children [" + face_set() + "] }"), in_mm),
             0.02);
  // The orientation of the faces is the opposite of the orientation in the file.
  CHECK(folder.import("clockwise.wrl", vrml(face_set("ccw FALSE")), in_mm).report.repairs.turned_parts == 1);
  const auto copies = folder.import(
      "copies.wrl", vrml("DEF Body " + face_set() + "Transform { translation 100 0 0 children [ USE Body ] }"), in_mm);
  CHECK(copies.report.measurements.closed_parts == 2);
  folder.write("part.wrl", vrml(face_set()));
  check_cube(folder.import("whole.wrl", vrml("Inline { url \"part.wrl\" }"), in_mm), 0.02);
  check_cube(folder.import("cube.WRL", vrml(face_set("solid FALSE creaseAngle 0.5")), in_mm), 0.02);
  // Nodes without a shape, a missing picture and a prototype.
  check_cube(
      folder.import("scene.wrl",
                    vrml("WorldInfo { title \"Test\" } Viewpoint { } PROTO Part [ field SFVec3f size 1 1 1 ] { Shape { "
                         "geometry Box { size IS size } } } Part { size 20 20 20 } Shape { appearance Appearance { "
                         "texture ImageTexture { url \"none.jpg\" } } }"),
                    in_mm),
      0.02);
  REQUIRE(
      std::system(fmt::format("gzip -c '{}' > '{}'", (folder / "cube.wrl").string(), (folder / "cube.wrl.gz").string())
                      .c_str()) == 0);
  check_cube(import_object(folder / "cube.wrl.gz", in_mm), 0.02);
}

TEST_CASE("concave faces, extrusions and bodies of a VRML file are closed and have the right volume") {
  const Folder folder;
  const auto volume = [&](const std::string& geometry) {
    const auto object =
        folder.import("a.wrl", vrml("Shape { geometry " + geometry + " }"), {.unit = importer::Unit::meter});
    CHECK(object.report.measurements.is_closed());
    CHECK(object.report.repairs.turned == 0);
    return object.report.measurements.volume_m3;
  };
  const std::string arrow =
      "coord Coordinate { point [0 0 0, 4 0 0, 4 4 0, 2 1 0, 0 4 0, 0 0 -1, 4 0 -1, 4 4 -1, 2 1 -1, 0 4 -1] } "
      "coordIndex "
      "[0 1 2 3 4 -1 9 8 7 6 5 -1 0 5 6 1 -1 1 6 7 2 -1 2 7 8 3 -1 3 8 9 4 -1 4 9 5 0 -1]";
  CHECK(volume("IndexedFaceSet { convex FALSE " + arrow + " }") == doctest::Approx(10));
  CHECK(volume("IndexedFaceSet { " + arrow + " }") == doctest::Approx(10));
  // Overlapping triangles have a larger area, but the same signed volume.
  const auto declared_convex = folder.import("a.wrl", vrml("Shape { geometry IndexedFaceSet { " + arrow + " } }"),
                                             {.unit = importer::Unit::meter});
  CHECK(declared_convex.report.measurements.area_m2 == doctest::Approx(2 * 10 + 12 + 2 * std::hypot(2, 3)));
  CHECK(volume("Extrusion { crossSection [2 2, 2 -2, 0 -1, -2 -2, -2 2, 2 2] spine [0 0 0, 0 4 0] }") ==
        doctest::Approx(56));
  CHECK(volume("Box { size 1 2 3 }") == doctest::Approx(6));
  CHECK(volume("Sphere { radius 2 }") == doctest::Approx(33.51).epsilon(0.003));
  CHECK(volume("Cylinder { radius 2 height 3 }") == doctest::Approx(37.70).epsilon(0.003));
  CHECK(volume("Cone { bottomRadius 2 height 3 }") == doctest::Approx(12.57).epsilon(0.003));
}

TEST_CASE("lengths of a VRML file are meters, or millimeters if meters are absurd") {
  const Folder folder;
  const auto meters = folder.import("a.wrl", vrml("Shape { geometry Box { size 0.1 0.1 0.1 } }"));
  CHECK(meters.unit == importer::Unit::meter);
  CHECK(meters.unit_source == importer::UnitSource::file);
  const auto millimeters = folder.import("a.wrl", vrml("Shape { geometry Box { size 80 80 80 } }"));
  CHECK(millimeters.unit == importer::Unit::millimeter);
  CHECK(millimeters.unit_source == importer::UnitSource::proposal);
  CHECK(has_remark(millimeters, "the object would be 80 m long. The program assumes mm"));
}

TEST_CASE("an invalid VRML file is refused with a sentence") {
  const Folder folder;
  CHECK(contains(folder.refusal("a.wrl", vrml("Inline { url \"none.wrl\" }")),
                 "includes none.wrl, which cannot be opened"));
  CHECK(contains(folder.refusal("a.wrl", vrml("Inline { url \"a.wrl\" }")), "includes itself"));
  folder.write("b.wrl", vrml("Inline { url \"c.wrl\" } Inline { url \"c.wrl\" }"));
  CHECK(
      contains(folder.refusal("c.wrl", vrml("Inline { url \"b.wrl\" } Inline { url \"b.wrl\" }")), "includes itself"));
  CHECK(contains(folder.refusal("a.wrl", vrml(face_set()).substr(0, 250)),
                 "not a valid VRML file (Premature end of file, line 2)"));
  CHECK(contains(folder.refusal("a.wrl", vrml("Unheard { of 1 }")), "not a valid VRML file"));
  CHECK(contains(folder.refusal("a.wrl", vrml("")), "a.wrl"));
  CHECK(contains(folder.refusal("a.wrl", "no VRML"), "a.wrl"));
  CHECK(contains(
      folder.refusal("a.wrl", vrml("Shape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0] } coordIndex "
                                   "[0 1 2000000000 -1] } }")),
      "a.wrl"));
  CHECK(contains(folder.refusal("a.wrl.gz", "\x1F\x8B\x08 damaged"), "a.wrl.gz"));
}

TEST_CASE("files that are no objects are refused with a sentence") {
  const Folder folder;
  const auto refusal = [](const std::filesystem::path& file) {
    return message_of<importer::Error>([&] { import_object(file); });
  };
  CHECK(contains(refusal(folder / "none.stl"), "none.stl cannot be opened: No such file or directory"));
  CHECK(contains(folder.refusal("a.stl", ""), "a.stl is empty"));
  CHECK(contains(folder.refusal("a.png", "\x89PNG"), "unknown format. Export the object as one of .stl"));
  std::filesystem::create_directory(folder / "folder.stl");
  CHECK(contains(refusal(folder / "folder.stl"), "is not a file"));
  REQUIRE(mkfifo((folder / "pipe.stl").c_str(), 0600) == 0);
  CHECK(contains(refusal(folder / "pipe.stl"), "is not a file"));
  const auto sparse = folder.write("large.stl", "solid");
  std::filesystem::resize_file(sparse, std::uintmax_t{10} << 30);
  CHECK(contains(refusal(sparse), "the limit is 1024 MB"));
  CHECK(contains(folder.refusal("line.stl", binary_stl({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}})),
                 "only triangles without area"));
}

TEST_CASE("the helper program ends at its limits of memory and time, and when the import is canceled") {
  const Folder folder;
  const auto refusal = [&](const importer::ImportOptions& options) {
    return message_of<importer::Error>([&] { import_object(folder / "0.wrl", options); });
  };
  // Ten to the power of eight files.
  for (int depth = 0; depth < 8; ++depth) {
    std::string inlines;
    for (int i = 0; i < 10; ++i) inlines += fmt::format("Inline {{ url \"{}.wrl\" }} ", depth + 1);
    folder.write(fmt::format("{}.wrl", depth), vrml(inlines));
  }
  folder.write("8.wrl", vrml(face_set()));
  CHECK(contains(refusal({.limits = {.processor_time = std::chrono::seconds(1)}}),
                 "needs more than 1 s of processor time"));
  CHECK(contains(refusal({.limits = {.memory_bytes = 200'000'000, .processor_time = std::chrono::seconds(20)}}),
                 "0.wrl"));
  CHECK(contains(refusal({.limits = {.wall_time = std::chrono::seconds(0)}}), "takes longer than 0 s"));
  int calls = 0;
  CHECK(contains(refusal({.progress = [&](double) { return ++calls < 4; }}), "canceled"));
  CHECK(calls == 4);
}
