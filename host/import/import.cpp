#include "host/import/import.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

#include "host/import/file_content.hpp"
#include "host/import/readers.hpp"

namespace inkwell::importer {
namespace {

/// A regular file that is open for reading.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path) : name_(path.filename().string()) {
    // Without O_NONBLOCK, a pipe without a writer blocks.
    file_ = local::Descriptor(
        local::repeat_interrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); }));
    if (!file_.is_open())
      fail(fmt::format("cannot be opened: {}. Check its name and its permissions", std::strerror(errno)));
    struct stat status {};
    if (::fstat(file_.number(), &status) != 0 || !S_ISREG(status.st_mode))
      fail("is not a file. Name a file with an object");
    size_ = static_cast<std::size_t>(status.st_size);
    if (size_ == 0) fail("is empty. Export the object again");
    if (size_ > file_bytes_max)
      fail(fmt::format("has {} MB, and the limit is {} MB. Reduce the object in a mesh editor", size_ >> 20,
                       file_bytes_max >> 20));
  }

  const std::string& name() const { return name_; }
  std::size_t size() const { return size_; }

  /// Reads up to `count` bytes from the start of the file.
  std::vector<std::byte> read(std::size_t count) const {
    std::vector<std::byte> bytes(std::min(count, size_));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto more = local::repeat_interrupted(
          [&] { return ::pread(file_.number(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(done)); });
      if (more < 0) fail(fmt::format("cannot be read: {}. Copy the file again", std::strerror(errno)));
      if (more == 0) break;
      done += static_cast<std::size_t>(more);
    }
    bytes.resize(done);
    return bytes;
  }

  [[noreturn]] void fail(const std::string& problem) const { throw Error(fmt::format("{} {}.", name_, problem)); }

 private:
  std::string name_;
  local::Descriptor file_;
  std::size_t size_ = 0;
};

FileContent read_content(const InputFile& file, const std::filesystem::path& path, Format format,
                         const ImportOptions& options) {
  switch (format) {
    case Format::stl: return read_stl(file.read(file.size()), file.name());
    case Format::ply: return read_ply(file.read(file.size()), file.name());
    case Format::obj:
    case Format::gltf:
    case Format::vrml: break;
  }
  return read_in_child(path, format, options.limits, options.progress);
}

struct Range {
  glm::dvec3 minimum{1e300}, maximum{-1e300};

  double longest_side() const {
    const glm::dvec3 size = maximum - minimum;
    return std::max({size.x, size.y, size.z});
  }
};

Range range_of(const FileContent& content) {
  Range range;
  for (const geometry::Face& face : content.faces)
    for (const std::uint32_t index : face) {
      range.minimum = glm::min(range.minimum, content.vertices[index]);
      range.maximum = glm::max(range.maximum, content.vertices[index]);
    }
  return range;
}

/// Sets the unit of the object, and explains a proposed unit.
void choose_unit(Object& object, const FileContent& content, double longest_side, const ImportOptions& options) {
  if (options.unit) {
    object.unit = *options.unit;
    object.unit_source = UnitSource::user;
    return;
  }
  object.unit = content.unit.value_or(propose_unit(longest_side));
  object.unit_source = content.unit ? UnitSource::file : UnitSource::proposal;
  // No object of this size fits on a desk.
  constexpr double doubtful_m = 2;
  const auto size_text = [&](Unit unit) { return length_text(longest_side * meters_per(unit)); };
  if (content.unit && content.is_unit_doubtful && longest_side * meters_per(*content.unit) > doubtful_m) {
    object.unit = propose_unit(longest_side);
    object.unit_source = UnitSource::proposal;
    object.remarks.push_back(fmt::format(
        "{} files state lengths in {}, but the object would be {} long. The program assumes {}, so it is {} "
        "long. Set another unit with --unit.",
        name_of(object.format), symbol_of(*content.unit), size_text(*content.unit), symbol_of(object.unit),
        size_text(object.unit)));
  } else if (!content.unit) {
    object.remarks.push_back(
        fmt::format("{} files state no unit. The program assumes {}, so the object is {} long. Set "
                    "another unit with --unit.",
                    name_of(object.format), symbol_of(object.unit), size_text(object.unit)));
  }
}

/// Moves the object to its middle in double precision, because an object far from the origin has no digits left in
/// single precision.
geometry::Mesh welded_mesh(const FileContent& content, const Range& range, double factor_m) {
  const glm::dvec3 middle = 0.5 * (range.minimum + range.maximum);
  std::vector<glm::vec3> vertices_m;
  vertices_m.reserve(content.vertices.size());
  for (const glm::dvec3& vertex : content.vertices) vertices_m.emplace_back((vertex - middle) * factor_m);
  return geometry::weld(vertices_m, content.faces);
}

std::string count_text(std::size_t count, std::string_view thing) {
  return count == 1 ? fmt::format("1 {}", thing) : fmt::format("{} {}s", count, thing);
}

}  // namespace

std::vector<std::string> remarks_on(const geometry::Report& report) {
  const auto& [measured, repairs] = report;
  std::vector<std::string> remarks;
  const auto add = [&](std::size_t count, std::string_view thing, std::string_view singular, std::string_view plural) {
    if (count > 0)
      remarks.push_back(fmt::format("{} {} {}.", count_text(count, thing), count == 1 ? "was" : "were",
                                    count == 1 ? singular : plural));
  };
  add(repairs.degenerate, "triangle", "removed, because it has no area", "removed, because they have no area");
  add(repairs.needles, "triangle", "replaced, because it has almost no height",
      "replaced, because they have almost no height");
  add(repairs.duplicates, "duplicate triangle", "removed", "removed");
  add(repairs.turned, "flipped triangle", "turned", "turned");
  add(repairs.turned_parts, "part", "turned, because it was inside out", "turned, because they were inside out");
  if (!measured.is_closed()) {
    const std::string reason =
        measured.open_edges > 0 ? fmt::format(" at {}", count_text(measured.open_edges, "edge"))
        : measured.flipped_edges > 0
            ? std::string(", because its triangles cannot have one orientation")
            : fmt::format(", because its walls branch at {}", count_text(measured.branched_edges, "edge"));
    remarks.push_back(fmt::format("The mesh is open{}. It is a surface with two sides, and has no inside.", reason));
  }
  return remarks;
}

Object import_object(const std::filesystem::path& path, const ImportOptions& options) {
  const InputFile file(path);
  const auto advance = [&](double fraction) {
    if (options.progress && !options.progress(fraction)) file.fail("was not imported, because the import was canceled");
  };
  constexpr std::size_t signature_bytes = 64;
  const auto format = detect_format(path, file.read(signature_bytes));
  if (!format) file.fail(fmt::format("has an unknown format. Export the object as one of {}", known_extensions));
  if (!(options.scale > 0) || !std::isfinite(options.scale)) file.fail("needs a positive scale. Correct --scale");
  advance(0);

  FileContent content = read_content(file, path, *format, options);
  check(content, file.name());
  advance(0.5);
  Object object{.name = file.name(), .format = *format};
  object.remarks = std::move(content.remarks);
  const Range range = range_of(content);
  choose_unit(object, content, range.longest_side() * options.scale, options);
  const double factor_m = meters_per(object.unit) * options.scale;
  object.middle_m = 0.5 * factor_m * (range.minimum + range.maximum);
  object.mesh = welded_mesh(content, range, factor_m);
  content = {};
  advance(0.7);
  object.report = geometry::repair(object.mesh);
  advance(1);
  if (object.mesh.faces.empty())
    file.fail("contains only triangles without area, so there is nothing to touch. Export the object again");
  for (std::string& remark : remarks_on(object.report)) object.remarks.push_back(std::move(remark));
  return object;
}

}  // namespace inkwell::importer
