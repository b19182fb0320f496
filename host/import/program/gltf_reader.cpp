#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include <tiny_gltf.h>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <nlohmann/json.hpp>

#include "host/import/error.hpp"
#include "host/import/program/object_readers.hpp"

namespace inkwell::importer {
namespace {

[[noreturn]] void refuse_gltf(const std::string& name, const std::string& problem) {
  throw Error(fmt::format("{} {}. Export the file again.", name, problem));
}

[[noreturn]] void refuse_version(const std::string& name) {
  throw Error(fmt::format("{} has another version of glTF than 2. Export the object as glTF 2.", name));
}

// ---- Version and required extensions

/// Extensions that do not change the shape. Names that end with _ are prefixes.
constexpr std::array harmless_extensions{"KHR_mesh_quantization", "KHR_lights_punctual", "KHR_materials_",
                                         "KHR_texture_",          "EXT_texture_",        "MSFT_texture_"};

bool is_harmless(const std::string& extension) {
  return std::ranges::any_of(harmless_extensions, [&](std::string_view known) {
    return known.ends_with('_') ? extension.starts_with(known) : extension == known;
  });
}

/// The JSON text of a .gltf or a .glb file. @throws Error.
std::string_view json_text(std::span<const std::byte> file, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (!text.starts_with("glTF")) return text;
  constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
  if (file.size() < header_bytes + chunk_header_bytes) refuse_gltf(name, "is incomplete");
  std::uint32_t size = 0;
  std::memcpy(&size, file.data() + header_bytes, sizeof size);
  std::uint32_t version = 0;
  std::memcpy(&version, file.data() + 4, sizeof version);
  if (version != 2) refuse_version(name);
  if (size > file.size() - header_bytes - chunk_header_bytes) refuse_gltf(name, "is incomplete");
  return text.substr(header_bytes + chunk_header_bytes, size);
}

/// tinygltf loads files of version 1 without their meshes, and files with unknown required extensions as if
/// these were absent.
void check_version_and_extensions(std::span<const std::byte> file, const std::string& name) {
  const auto text = json_text(file, name);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) refuse_gltf(name, "does not contain valid JSON, so it is not a glTF file or it is incomplete");
  const auto asset = json.find("asset");
  const bool is_version_2 =
      asset != json.end() && asset->is_object() && asset->value("version", std::string()).starts_with("2");
  if (!is_version_2) refuse_version(name);
  const auto found = json.find("extensionsRequired");
  if (found == json.end() || !found->is_array()) return;
  for (const auto& extension : *found)
    if (extension.is_string() && !is_harmless(extension.get<std::string>()))
      throw Error(
          fmt::format("{} requires the glTF extension {}, which this program does not support. Export the file "
                      "without this extension.",
                      name, extension.get<std::string>()));
}

// ---- Files

/// tinygltf reads images and buffers with these functions. Images are not needed.
tinygltf::FsCallbacks file_access(std::string& name) {
  tinygltf::FsCallbacks access{};
  access.FileExists = [](const std::string& file, void*) {
    std::error_code code;
    return std::filesystem::is_regular_file(file, code);
  };
  access.ExpandFilePath = [](const std::string& file, void*) { return file; };
  access.ReadWholeFile = [](std::vector<unsigned char>* content, std::string* error, const std::string& file,
                            void* user_data) {
    try {
      const auto bytes = read_file(file, *static_cast<std::string*>(user_data));
      const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
      content->assign(begin, begin + bytes.size());
      return true;
    } catch (const Error& failure) {
      if (error != nullptr) *error += failure.what();
      return false;
    }
  };
  access.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  access.user_data = &name;
  return access;
}

bool skip_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

tinygltf::Model load_model(std::span<const std::byte> file, const std::filesystem::path& path, std::string name) {
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(file_access(name));
  loader.SetImageLoader(skip_image, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned>(file.size());
  const std::string folder = path.parent_path().string();
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const bool is_loaded =
      text.starts_with("glTF")
          ? loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(file.data()),
                                        size, folder)
          : loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, folder);
  if (!is_loaded) {
    std::ranges::replace(error, '\n', ' ');
    while (error.ends_with(' ') || error.ends_with('.')) error.pop_back();
    throw Error(fmt::format("{} is not a valid glTF file ({}). Export the file again, together with its .bin files.",
                            name, error));
  }
  return model;
}

// ---- Accessors

/// Numbers of an accessor, with all data inside its buffer.
class Accessor {
 public:
  Accessor(const tinygltf::Model& model, int number, const std::string& name) : model_(model), name_(name) {
    if (number < 0 || static_cast<std::size_t>(number) >= model.accessors.size()) fail();
    accessor_ = &model.accessors[static_cast<std::size_t>(number)];
    const int columns = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
    const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor_->componentType));
    if (columns <= 0 || bytes <= 0) fail();
    columns_ = static_cast<std::size_t>(columns);
    bytes_ = static_cast<std::size_t>(bytes);
    check_counts(accessor_->count, 0, name);
  }

  std::size_t count() const { return accessor_->count; }

  /// The values of all elements, one after the other. `columns`: the expected count of each element.
  std::vector<double> values(std::size_t columns) const {
    if (columns_ != columns) fail();
    std::vector<double> values(count() * columns);
    if (accessor_->bufferView >= 0) read(values, accessor_->bufferView, accessor_->byteOffset, count());
    if (accessor_->sparse.isSparse) replace_sparse(values);
    if (accessor_->normalized) normalize(values);
    return values;
  }

 private:
  /// The bytes of a buffer view from an offset. `stride`: of two elements; 0 means contiguous elements.
  std::span<const unsigned char> bytes_of(int view_number, std::size_t offset, std::size_t count,
                                          std::size_t element_bytes, std::size_t& stride) const {
    if (view_number < 0 || static_cast<std::size_t>(view_number) >= model_.bufferViews.size()) fail();
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(view_number)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) fail();
    std::span<const unsigned char> bytes(model_.buffers[static_cast<std::size_t>(view.buffer)].data);
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) fail();
    bytes = bytes.subspan(view.byteOffset, view.byteLength);
    if (offset > bytes.size()) fail();
    bytes = bytes.subspan(offset);
    stride = view.byteStride != 0 ? view.byteStride : element_bytes;
    if (count > 0 && (bytes.size() < element_bytes || (count - 1) > (bytes.size() - element_bytes) / stride)) fail();
    return bytes;
  }

  void read(std::vector<double>& values, int view, std::size_t offset, std::size_t elements) const {
    std::size_t stride = 0;
    const auto bytes = bytes_of(view, offset, elements, columns_ * bytes_, stride);
    for (std::size_t element = 0; element < elements; ++element)
      for (std::size_t column = 0; column < columns_; ++column)
        values[element * columns_ + column] =
            number_at(bytes.data() + element * stride + column * bytes_, accessor_->componentType);
  }

  void replace_sparse(std::vector<double>& values) const {
    const auto& sparse = accessor_->sparse;
    const int index_bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType));
    if (sparse.count < 0 || index_bytes <= 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) fail();
    const auto replaced = static_cast<std::size_t>(sparse.count);
    if (replaced > count()) fail();
    std::size_t stride = 0;
    const auto indices = bytes_of(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                                  replaced, static_cast<std::size_t>(index_bytes), stride);
    std::vector<double> replacements(replaced * columns_);
    read(replacements, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), replaced);
    for (std::size_t i = 0; i < replaced; ++i) {
      const double index = number_at(indices.data() + i * stride, sparse.indices.componentType);
      if (!(index >= 0 && index < static_cast<double>(count()))) fail();
      std::copy_n(replacements.begin() + static_cast<std::ptrdiff_t>(i * columns_), columns_,
                  values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(index) * columns_));
    }
  }

  template <class Value>
  static double value_at(const unsigned char* bytes) {
    Value value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }

  double number_at(const unsigned char* bytes, int type) const {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE: return value_at<std::int8_t>(bytes);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return value_at<std::uint8_t>(bytes);
      case TINYGLTF_COMPONENT_TYPE_SHORT: return value_at<std::int16_t>(bytes);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return value_at<std::uint16_t>(bytes);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return value_at<std::uint32_t>(bytes);
      case TINYGLTF_COMPONENT_TYPE_FLOAT: return value_at<float>(bytes);
      default: fail();
    }
  }

  /// glTF 2.0, section 3.6.2.2: a normalized integer is a fraction of its largest value.
  void normalize(std::vector<double>& values) const {
    double largest = 0;
    switch (accessor_->componentType) {
      case TINYGLTF_COMPONENT_TYPE_BYTE: largest = 127; break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: largest = 255; break;
      case TINYGLTF_COMPONENT_TYPE_SHORT: largest = 32767; break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: largest = 65535; break;
      default: return;
    }
    for (double& value : values) value = std::max(value / largest, -1.0);
  }

  [[noreturn]] void fail() const {
    refuse_gltf(name_, "has an accessor without its data, so the file is damaged or incomplete");
  }

  const tinygltf::Model& model_;
  const std::string& name_;
  const tinygltf::Accessor* accessor_ = nullptr;
  std::size_t columns_ = 0, bytes_ = 0;
};

// ---- Scene

glm::dmat4 matrix_of(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 matrix(1);
  if (node.translation.size() == 3)
    matrix[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
  if (node.rotation.size() == 4)
    matrix *= glm::mat4_cast(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
  if (node.scale.size() == 3)
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= node.scale[static_cast<std::size_t>(axis)];
  return matrix;
}

class GltfScene {
 public:
  GltfScene(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {}

  FileContent read() {
    content_.unit = Unit::meter;
    const auto roots = root_nodes();
    matrices_.resize(model_.nodes.size());
    for (const int root : roots) place(root, glm::dmat4(1), 0);
    for (std::size_t node = 0; node < model_.nodes.size(); ++node)
      if (matrices_[node] && model_.nodes[node].mesh >= 0) add_mesh(model_.nodes[node], *matrices_[node]);
    return std::move(content_);
  }

 private:
  /// Roots of the default scene. A file without scenes is a library of nodes, of which all are read.
  std::vector<int> root_nodes() const {
    const auto scene = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
    if (scene < model_.scenes.size()) return model_.scenes[scene].nodes;
    std::vector<bool> is_child(model_.nodes.size());
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children)
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
          is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t node = 0; node < is_child.size(); ++node)
      if (!is_child[node]) roots.push_back(static_cast<int>(node));
    return roots;
  }

  /// Computes the matrices of a node and of its children. Each node has one parent, so a second visit is an error.
  void place(int number, const glm::dmat4& parent, int depth) {
    constexpr int depth_max = 1000;
    if (number < 0 || static_cast<std::size_t>(number) >= model_.nodes.size() || depth > depth_max)
      refuse_gltf(name_, "refers to a node that does not exist");
    auto& matrix = matrices_[static_cast<std::size_t>(number)];
    if (matrix) refuse_gltf(name_, "has a node with two parents");
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(number)];
    matrix = parent * matrix_of(node);
    const glm::dmat4 own = *matrix;
    for (const int child : node.children) place(child, own, depth + 1);
  }

  void add_mesh(const tinygltf::Node& node, const glm::dmat4& matrix) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
      refuse_gltf(name_, "refers to a mesh that does not exist");
    for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
      const auto position = primitive.attributes.find("POSITION");
      const bool has_triangles = primitive.mode == -1 || primitive.mode == TINYGLTF_MODE_TRIANGLES ||
                                 primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                                 primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
      if (!has_triangles || position == primitive.attributes.end()) continue;
      add_primitive(primitive, Accessor(model_, position->second, name_), node, matrix);
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const Accessor& position, const tinygltf::Node& node,
                     const glm::dmat4& matrix) {
    const auto first = static_cast<std::uint32_t>(content_.vertices.size());
    check_counts(first + position.count(), 0, name_);
    const auto values = position.values(3);
    const auto skin = skin_matrices(primitive, node, position.count());
    for (std::size_t vertex = 0; vertex < position.count(); ++vertex) {
      const glm::dvec4 point(values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2], 1);
      content_.vertices.emplace_back((skin.empty() ? matrix : skin[vertex]) * point);
    }
    // A skinned mesh ignores the matrix of its node.
    const bool is_mirrored = glm::determinant(glm::dmat3(skin.empty() ? matrix : skin[0])) < 0;
    add_faces(primitive, first, position.count(), is_mirrored);
  }

  void add_faces(const tinygltf::Primitive& primitive, std::uint32_t first, std::size_t vertex_count,
                 bool is_mirrored) {
    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
      for (const double index : Accessor(model_, primitive.indices, name_).values(1)) {
        if (!(index >= 0 && index < static_cast<double>(vertex_count)))
          refuse_gltf(name_, fmt::format("has a triangle that refers to vertex {}, but there are only {} vertices",
                                         index, vertex_count));
        corners.push_back(static_cast<std::uint32_t>(index));
      }
    } else {
      for (std::uint32_t index = 0; index < vertex_count; ++index) corners.push_back(index);
    }
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (is_mirrored) std::swap(b, c);
      content_.faces.push_back({first + a, first + b, first + c});
    };
    check_counts(0, content_.faces.size() + corners.size(), name_);
    switch (primitive.mode) {
      case TINYGLTF_MODE_TRIANGLE_STRIP:
        for (std::size_t i = 2; i < corners.size(); ++i) {
          const bool is_turned = i % 2 != 0;
          add(corners[i - 2], corners[is_turned ? i : i - 1], corners[is_turned ? i - 1 : i]);
        }
        break;
      case TINYGLTF_MODE_TRIANGLE_FAN:
        for (std::size_t i = 2; i < corners.size(); ++i) add(corners[0], corners[i - 1], corners[i]);
        break;
      default:
        for (std::size_t i = 2; i < corners.size(); i += 3) add(corners[i - 2], corners[i - 1], corners[i]);
    }
  }

  /// One matrix for each vertex of a skinned mesh in the rest pose of its joints. Empty without a skin.
  std::vector<glm::dmat4> skin_matrices(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                                        std::size_t vertex_count) const {
    const auto joints = primitive.attributes.find("JOINTS_0"), weights = primitive.attributes.find("WEIGHTS_0");
    if (node.skin < 0 || joints == primitive.attributes.end() || weights == primitive.attributes.end()) return {};
    if (static_cast<std::size_t>(node.skin) >= model_.skins.size())
      refuse_gltf(name_, "refers to a skin that does not exist");
    const auto joint_matrices = matrices_of_joints(model_.skins[static_cast<std::size_t>(node.skin)]);
    const auto joint_numbers = Accessor(model_, joints->second, name_).values(4);
    const auto shares = Accessor(model_, weights->second, name_).values(4);
    if (joint_numbers.size() != 4 * vertex_count || shares.size() != 4 * vertex_count)
      refuse_gltf(name_, "has a skin of another size than its mesh");
    std::vector<glm::dmat4> matrices(vertex_count, glm::dmat4(0));
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (shares[i] == 0) continue;
      if (!(joint_numbers[i] < static_cast<double>(joint_matrices.size())))
        refuse_gltf(name_, "has a skin that refers to a joint that does not exist");
      matrices[i / 4] += shares[i] * joint_matrices[static_cast<std::size_t>(joint_numbers[i])];
    }
    return matrices;
  }

  std::vector<glm::dmat4> matrices_of_joints(const tinygltf::Skin& skin) const {
    std::vector<double> inverse;
    if (skin.inverseBindMatrices >= 0) inverse = Accessor(model_, skin.inverseBindMatrices, name_).values(16);
    std::vector<glm::dmat4> matrices;
    for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
      const int node = skin.joints[joint];
      if (node < 0 || static_cast<std::size_t>(node) >= matrices_.size() || !matrices_[static_cast<std::size_t>(node)])
        refuse_gltf(name_, "has a skin with a joint outside the scene");
      if (!inverse.empty() && inverse.size() < 16 * (joint + 1)) refuse_gltf(name_, "has a skin without its matrices");
      const glm::dmat4 bind = inverse.empty() ? glm::dmat4(1) : glm::dmat4(glm::make_mat4(inverse.data() + 16 * joint));
      matrices.push_back(*matrices_[static_cast<std::size_t>(node)] * bind);
    }
    return matrices;
  }

  const tinygltf::Model& model_;
  const std::string& name_;
  std::vector<std::optional<glm::dmat4>> matrices_{};  ///< of the nodes in the scene, to scene coordinates
  FileContent content_{};
};

}  // namespace

FileContent read_gltf(const std::filesystem::path& file, const std::string& name) {
  const auto bytes = read_file(file, name);
  check_version_and_extensions(bytes, name);
  return GltfScene(load_model(bytes, file, name), name).read();
}

}  // namespace inkwell::importer
