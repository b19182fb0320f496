#include "host/feel/loading.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/geometry/examples.hpp"
#include "host/import/placement.hpp"

namespace inkwell::feel {
namespace {

/// Share of the import in the progress. The rest is the search tree.
constexpr double import_share = 0.5;

geometry::Mesh make_example(const std::string& name) {
  const auto examples = geometry::examples();
  const auto found = std::ranges::find(examples, name, &geometry::Example::name);
  if (found != examples.end()) return found->make();
  std::vector<std::string_view> names;
  for (const geometry::Example& example : examples) names.push_back(example.name);
  throw importer::Error(fmt::format("There is no example {}. Choose one of these: {}.", name, fmt::join(names, ", ")));
}

std::string unit_text_of(const importer::Object& object) {
  const std::string_view symbol = importer::symbol_of(object.unit);
  switch (object.unit_source) {
    case importer::UnitSource::file: return fmt::format("{}, from the file", symbol);
    case importer::UnitSource::user: return fmt::format("{}, from --unit", symbol);
    case importer::UnitSource::proposal: return fmt::format("{}, assumed; --unit changes it", symbol);
  }
  return {};
}

void scale_mesh(geometry::Mesh& mesh, double scale) { importer::apply({scale, {}}, mesh); }

glm::dvec3 middle_of(const geometry::Box& box) { return 0.5 * (glm::dvec3(box.minimum_m) + glm::dvec3(box.maximum_m)); }

}  // namespace

LoadedObject load_object(const LoadRequest& request, const importer::Progress& progress) {
  const auto part = [&progress](double from, double to) -> importer::Progress {
    if (!progress) return {};
    return [&progress, from, to](double done) { return progress(from + (to - from) * done); };
  };
  LoadedObject loaded;
  geometry::Mesh mesh;
  if (request.example.empty()) {
    importer::Object object = importer::import_object(
        request.file, {.unit = request.unit, .scale = request.scale, .limits = {}, .progress = part(0, import_share)});
    loaded.name = object.name;
    loaded.unit_text = unit_text_of(object);
    loaded.remarks = std::move(object.remarks);
    mesh = std::move(object.mesh);
  } else {
    mesh = make_example(request.example);
    loaded.name = request.example;
    if (request.scale != 1) scale_mesh(mesh, request.scale);
  }
  const geometry::Box box = geometry::bounding_box(mesh);
  if (request.is_fit) {
    const double scale = importer::fit_to_workspace(box, request.workspace).scale;
    scale_mesh(mesh, scale);
    loaded.remarks.push_back(fmt::format("The object is fitted to the workspace: its scale is {:.3g}.", scale));
  } else if (const std::string remark = importer::size_remark(box, request.workspace); !remark.empty()) {
    throw importer::Error(remark + " Or use --fit.");
  }
  loaded.measurements = geometry::measure(mesh);
  loaded.placement.position_m = middle_of(request.workspace) - middle_of(geometry::bounding_box(mesh));
  loaded.surface = geometry::Surface::build(std::move(mesh), part(import_share, 1));
  if (!loaded.surface) throw importer::Error("The loading was canceled.");
  return loaded;
}

Loading::Loading(LoadRequest request)
    : name_(request.example.empty() ? request.file.filename().string() : request.example),
      loaded_(std::async(std::launch::async, [this, request = std::move(request)] {
        return load_object(request, [this](double done) {
          progress_ = done;
          return !is_canceled_;
        });
      })) {}

Loading::~Loading() { cancel(); }

std::string Loading::step() const {
  return fmt::format("loading {}: {}", name_,
                     progress_ < import_share ? "reading the mesh" : "building the search tree");
}

bool Loading::is_done_within(std::chrono::milliseconds time) const {
  return loaded_.wait_for(time) == std::future_status::ready;
}

}  // namespace inkwell::feel
