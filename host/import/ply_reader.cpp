#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "host/import/error.hpp"
#include "host/import/polygon.hpp"
#include "host/import/readers.hpp"
#include "host/import/text_scanner.hpp"

namespace inkwell::importer {
namespace {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyTypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array ply_type_names{
    PlyTypeName{"char", PlyType::int8},      PlyTypeName{"int8", PlyType::int8},
    PlyTypeName{"uchar", PlyType::uint8},    PlyTypeName{"uint8", PlyType::uint8},
    PlyTypeName{"short", PlyType::int16},    PlyTypeName{"int16", PlyType::int16},
    PlyTypeName{"ushort", PlyType::uint16},  PlyTypeName{"uint16", PlyType::uint16},
    PlyTypeName{"int", PlyType::int32},      PlyTypeName{"int32", PlyType::int32},
    PlyTypeName{"uint", PlyType::uint32},    PlyTypeName{"uint32", PlyType::uint32},
    PlyTypeName{"float", PlyType::float32},  PlyTypeName{"float32", PlyType::float32},
    PlyTypeName{"double", PlyType::float64}, PlyTypeName{"float64", PlyType::float64},
};

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8: return 1;
    case PlyType::int16:
    case PlyType::uint16: return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32: return 4;
    case PlyType::float64: return 8;
  }
  return 1;
}

struct PlyProperty {
  std::string name{};
  PlyType type{};
  bool is_list = false;
  PlyType count_type{};
};

struct PlyElement {
  std::string name{};
  std::size_t count = 0;
  std::vector<PlyProperty> properties{};
};

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding{};
  std::vector<PlyElement> elements{};
  std::size_t bytes = 0;
};

class PlyHeaderReader {
 public:
  PlyHeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  PlyHeader read() {
    if (next_line() != "ply") fail("does not start with the line \"ply\"");
    bool has_encoding = false;
    for (;;) {
      if (at_ >= text_.size()) fail("has no line \"end_header\"");
      TextScanner words(next_line());
      const auto key = words.word();
      if (key == "end_header") break;
      if (key == "format") {
        set_encoding(words.word());
        has_encoding = true;
      } else if (key == "element") {
        add_element(words);
      } else if (key == "property") {
        add_property(words);
      }
    }
    if (!has_encoding) fail("has no line \"format\"");
    header_.bytes = at_;
    return std::move(header_);
  }

 private:
  /// Binary data may start with a line feed, so all lines end like the first one.
  std::string_view next_line() {
    if (line_end_.empty()) {
      const std::size_t end = text_.find_first_of("\r\n");
      line_end_ = end == text_.npos ? "\n" : text_.substr(end).starts_with("\r\n") ? "\r\n" : text_.substr(end, 1);
    }
    const std::size_t end = std::min(text_.find(line_end_, at_), text_.size());
    const auto line = text_.substr(at_, end - at_);
    at_ = std::min(end + line_end_.size(), text_.size());
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

  void set_encoding(std::string_view word) {
    if (word == "ascii")
      header_.encoding = PlyEncoding::ascii;
    else if (word == "binary_little_endian")
      header_.encoding = PlyEncoding::little_endian;
    else if (word == "binary_big_endian")
      header_.encoding = PlyEncoding::big_endian;
    else
      fail(fmt::format("has the unknown format \"{}\"", word));
  }

  void add_element(TextScanner& words) {
    const std::string element(words.word());
    const auto count = words.number();
    if (!count || !(*count >= 0 && *count <= 1e15))
      fail(fmt::format("announces the element \"{}\" without a valid count", element));
    header_.elements.push_back({element, static_cast<std::size_t>(*count)});
  }

  void add_property(TextScanner& words) {
    if (header_.elements.empty()) fail("has a property before the first element");
    PlyProperty property;
    auto word = words.word();
    if (word == "list") {
      property.is_list = true;
      property.count_type = type_of(words.word());
      word = words.word();
    }
    property.type = type_of(word);
    property.name = words.word();
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type_of(std::string_view word) {
    const auto found = std::ranges::find(ply_type_names, word, &PlyTypeName::name);
    if (found == ply_type_names.end()) fail(fmt::format("has a property of the unknown type \"{}\"", word));
    return found->type;
  }

  [[noreturn]] void fail(const std::string& problem) {
    throw Error(fmt::format("{} {}, so it is not a valid PLY file. Export the file again.", name_, problem));
  }

  std::string_view text_, line_end_{};
  const std::string& name_;
  std::size_t at_ = 0;
  PlyHeader header_;
};

/// Thrown at the end of the file.
struct PlyEnd {};

class AsciiValues {
 public:
  explicit AsciiValues(std::string_view text) : size_(text.size()), scanner_(text) {}

  double next(PlyType /*type*/) {
    const auto word = scanner_.word();
    if (word.empty()) throw PlyEnd{};
    const auto number = parse_number(word);
    if (!number) throw PlyEnd{};
    return *number;
  }
  std::size_t rest_bytes() const { return size_ - scanner_.position(); }
  /// A digit and a blank.
  static std::size_t least_bytes(PlyType /*type*/) { return 2; }

 private:
  std::size_t size_;
  TextScanner scanner_;
};

class BinaryValues {
 public:
  BinaryValues(std::span<const std::byte> bytes, bool is_swapped) : bytes_(bytes), is_swapped_(is_swapped) {}

  double next(PlyType type) {
    switch (type) {
      case PlyType::int8: return value<std::int8_t>();
      case PlyType::uint8: return value<std::uint8_t>();
      case PlyType::int16: return value<std::int16_t>();
      case PlyType::uint16: return value<std::uint16_t>();
      case PlyType::int32: return value<std::int32_t>();
      case PlyType::uint32: return value<std::uint32_t>();
      case PlyType::float32: return static_cast<double>(value<float>());
      case PlyType::float64: return value<double>();
    }
    return 0;
  }
  std::size_t rest_bytes() const { return bytes_.size(); }
  static std::size_t least_bytes(PlyType type) { return size_of(type); }

 private:
  template <class Value>
  Value value() {
    if (bytes_.size() < sizeof(Value)) throw PlyEnd{};
    std::array<std::byte, sizeof(Value)> raw;
    std::memcpy(raw.data(), bytes_.data(), raw.size());
    bytes_ = bytes_.subspan(raw.size());
    if (is_swapped_) std::ranges::reverse(raw);
    return std::bit_cast<Value>(raw);
  }

  std::span<const std::byte> bytes_;
  bool is_swapped_;
};

template <class Values>
class PlyBody {
 public:
  PlyBody(Values values, const PlyHeader& header, const std::string& name)
      : values_(std::move(values)), header_(header), name_(name) {}

  FileContent read() {
    for (const PlyElement& element : header_.elements) {
      check_size(element);
      try {
        if (element.name == "vertex")
          read_vertices(element);
        else if (element.name == "face" || element.name == "tristrips")
          read_lists(element, element.name == "tristrips");
        else
          for (std::size_t row = 0; row < rows_of(element); ++row)
            for (const PlyProperty& property : element.properties) skip(property);
      } catch (PlyEnd) {
        throw Error(
            fmt::format("{} ends or has an invalid number in its {} elements named \"{}\", so the file is "
                        "incomplete or damaged. Copy or export the file again.",
                        name_, element.count, element.name));
      }
    }
    if (content_.vertices.empty()) fail("contains no points");
    split_polygons();
    if (content_.faces.empty())
      fail("contains points but no faces. Compute a surface from the points in a mesh editor");
    return std::move(content_);
  }

 private:
  static constexpr std::uint32_t strip_end = 0xFFFFFFFF;

  /// Rows without properties have no data.
  static std::size_t rows_of(const PlyElement& element) { return element.properties.empty() ? 0 : element.count; }

  void check_size(const PlyElement& element) {
    std::size_t row_bytes = 0;
    for (const PlyProperty& property : element.properties)
      row_bytes += Values::least_bytes(property.is_list ? property.count_type : property.type);
    // The last number of an ASCII file may have no blank.
    if (row_bytes > 0 && element.count > (values_.rest_bytes() + 1) / row_bytes)
      fail(
          fmt::format("announces {} elements named \"{}\", which do not fit into the file. The file is incomplete or "
                      "damaged. Copy or export the file again",
                      element.count, element.name));
  }

  void read_vertices(const PlyElement& element) {
    std::array<std::size_t, 3> columns{};
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto found = std::ranges::find(element.properties, axes[axis], &PlyProperty::name);
      if (found == element.properties.end() || found->is_list)
        fail(fmt::format("has vertices without the property \"{}\". Export the file again", axes[axis]));
      columns[axis] = static_cast<std::size_t>(found - element.properties.begin());
    }
    check_counts(element.count, 0, name_);
    content_.vertices.reserve(element.count);
    for (std::size_t row = 0; row < element.count; ++row) {
      glm::dvec3 vertex(0);
      for (std::size_t column = 0; column < element.properties.size(); ++column) {
        const PlyProperty& property = element.properties[column];
        if (property.is_list) {
          skip(property);
          continue;
        }
        const double number = values_.next(property.type);
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (columns[axis] == column) vertex[static_cast<int>(axis)] = number;
      }
      content_.vertices.push_back(vertex);
    }
  }

  void read_lists(const PlyElement& element, bool are_strips) {
    const auto is_corners = [](const PlyProperty& property) {
      return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    const auto corners = std::ranges::find_if(element.properties, is_corners);
    if (corners == element.properties.end()) {
      if (element.count == 0) return;
      fail(fmt::format("has elements named \"{}\" without the list \"vertex_indices\". Export the file again",
                       element.name));
    }
    std::vector<std::uint32_t> list;
    for (std::size_t row = 0; row < element.count; ++row) {
      for (const PlyProperty& property : element.properties) {
        if (&property != &*corners) {
          skip(property);
          continue;
        }
        read_list(property, list);
        if (are_strips)
          add_strips(list);
        else
          add_polygon(list);
        check_counts(0, content_.faces.size() + polygon_corners_.size(), name_);
      }
    }
  }

  void read_list(const PlyProperty& property, std::vector<std::uint32_t>& list) {
    const std::size_t count = list_size(property);
    list.clear();
    list.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double number = values_.next(property.type);
      if (number == -1) {
        list.push_back(strip_end);
      } else {
        if (!(number >= 0 && number < strip_end))
          fail(fmt::format("has a face with the vertex number {}. Export the file again", number));
        list.push_back(static_cast<std::uint32_t>(number));
      }
    }
  }

  std::size_t list_size(const PlyProperty& property) {
    const double count = values_.next(property.count_type);
    if (!(count >= 0 && count * static_cast<double>(Values::least_bytes(property.type)) <=
                            static_cast<double>(values_.rest_bytes() + 1)))
      throw PlyEnd{};
    return static_cast<std::size_t>(count);
  }

  void skip(const PlyProperty& property) {
    const std::size_t count = property.is_list ? list_size(property) : 1;
    for (std::size_t i = 0; i < count; ++i) values_.next(property.type);
  }

  /// Every second triangle of a strip is turned. The number -1 starts a new strip.
  void add_strips(const std::vector<std::uint32_t>& list) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i] == strip_end)
        begin = i + 1;
      else if (i >= begin + 2)
        content_.faces.push_back((i - begin) % 2 == 0 ? geometry::Face{list[i - 2], list[i - 1], list[i]}
                                                      : geometry::Face{list[i - 1], list[i - 2], list[i]});
    }
  }

  void add_polygon(const std::vector<std::uint32_t>& list) {
    if (list.size() == 3) {
      content_.faces.push_back({list[0], list[1], list[2]});
    } else if (list.size() > 3) {
      if (list.size() > corners_max)
        fail(fmt::format("has a face with more than {} corners. Split the face in a mesh editor", corners_max));
      polygon_corners_.insert(polygon_corners_.end(), list.begin(), list.end());
      polygon_sizes_.push_back(static_cast<std::uint32_t>(list.size()));
    }
  }

  /// The vertices may follow the faces, so polygons are split at the end.
  void split_polygons() {
    std::span<const std::uint32_t> corners(polygon_corners_);
    for (const std::uint32_t size : polygon_sizes_) {
      const auto polygon = corners.first(size);
      corners = corners.subspan(size);
      if (const auto missing =
              std::ranges::find_if(polygon, [&](std::uint32_t index) { return index >= content_.vertices.size(); });
          missing != polygon.end())
        fail(fmt::format("has a face that refers to vertex {}, but there are only {} vertices. Export the file again",
                         *missing, content_.vertices.size()));
      append_triangles(content_.vertices, polygon, content_.faces);
    }
  }

  [[noreturn]] void fail(const std::string& problem) { throw Error(fmt::format("{} {}.", name_, problem)); }

  Values values_;
  const PlyHeader& header_;
  const std::string& name_;
  FileContent content_;
  std::vector<std::uint32_t> polygon_corners_, polygon_sizes_;
};

}  // namespace

FileContent read_ply(std::span<const std::byte> file, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const PlyHeader header = PlyHeaderReader(text, name).read();
  if (header.encoding == PlyEncoding::ascii)
    return PlyBody(AsciiValues(text.substr(header.bytes)), header, name).read();
  return PlyBody(BinaryValues(file.subspan(header.bytes), header.encoding == PlyEncoding::big_endian), header, name)
      .read();
}

}  // namespace inkwell::importer
