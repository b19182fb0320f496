#include "host/companion/command_line/commands.hpp"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/geometry/repair.hpp"
#include "host/import/import.hpp"
#include "host/import/placement.hpp"

#include "host/companion/command_line/arm_workspace.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;

struct MeshOptions {
  std::string file;
  std::string unit;
  double scale = 1;
};

importer::Object import_mesh(const MeshOptions& options) {
  importer::ImportOptions import{.scale = options.scale};
  if (!options.unit.empty()) import.unit = importer::parse_unit(options.unit);
  try {
    return importer::import_object(options.file, import);
  } catch (const importer::Error& error) {
    throw device::Error(error.what());
  }
}

std::string_view text_of(importer::UnitSource source) {
  switch (source) {
    case importer::UnitSource::file: return "from the file";
    case importer::UnitSource::user: return "from --unit";
    case importer::UnitSource::proposal: return "assumed";
  }
  return "";
}

std::string parts_text(const geometry::Measurements& measured) {
  const std::string parts = measured.parts == 1 ? "1 part" : fmt::format("{} parts", measured.parts);
  if (measured.is_closed()) return parts + ", closed";
  if (measured.closed_parts == 0) return parts + ", open";
  return fmt::format("{}, {} of them closed", parts, measured.closed_parts);
}

ordered_json array_of(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

ordered_json json_of(const importer::Object& object, const std::vector<std::string>& remarks) {
  const auto& [measured, repairs] = object.report;
  const glm::dvec3 minimum_m(measured.box.minimum_m), maximum_m(measured.box.maximum_m);
  return {{"file", object.name},
          {"format", importer::name_of(object.format)},
          {"unit", importer::symbol_of(object.unit)},
          {"unit_source", text_of(object.unit_source)},
          {"triangles", measured.triangles},
          {"vertices", measured.vertices},
          {"parts", measured.parts},
          {"closed_parts", measured.closed_parts},
          {"closed", measured.is_closed()},
          {"open_edges", measured.open_edges},
          {"branched_edges", measured.branched_edges},
          {"box_minimum_m", array_of(minimum_m + object.middle_m)},
          {"box_maximum_m", array_of(maximum_m + object.middle_m)},
          {"area_m2", measured.area_m2},
          {"volume_m3", measured.volume_m3},
          {"repairs",
           {{"degenerate", repairs.degenerate},
            {"needles", repairs.needles},
            {"duplicates", repairs.duplicates},
            {"flipped", repairs.turned},
            {"inside_out_parts", repairs.turned_parts}}},
          {"remarks", remarks}};
}

void print(const importer::Object& object, const std::vector<std::string>& remarks) {
  const auto& measured = object.report.measurements;
  const glm::dvec3 size_m = glm::dvec3(measured.box.maximum_m) - glm::dvec3(measured.box.minimum_m);
  fmt::print("file                {}, {}\n", object.name, importer::name_of(object.format));
  fmt::print("unit                {}, {}\n", importer::symbol_of(object.unit), text_of(object.unit_source));
  fmt::print("triangles           {}, with {} vertices\n", measured.triangles, measured.vertices);
  fmt::print("parts               {}\n", parts_text(measured));
  fmt::print("box                 {} x {} x {}\n", importer::length_text(size_m.x), importer::length_text(size_m.y),
             importer::length_text(size_m.z));
  const bool is_large = measured.area_m2 >= 1;
  fmt::print("area                {:.4g} {}\n", measured.area_m2 * (is_large ? 1 : 1e4), is_large ? "m2" : "cm2");
  if (measured.closed_parts > 0)
    fmt::print("volume              {:.4g} {}\n", measured.volume_m3 * (is_large ? 1 : 1e6), is_large ? "m3" : "cm3");
  for (const auto& remark : remarks) fmt::print("{}\n", remark);
}

int report_mesh(const DeviceOptions& device_options, const MeshOptions& options) {
  const geometry::Box workspace = arm_workspace(device_options);
  const importer::Object object = import_mesh(options);
  std::vector<std::string> remarks = object.remarks;
  if (std::string remark = importer::size_remark(object.report.measurements.box, workspace); !remark.empty())
    remarks.push_back(std::move(remark));
  if (device_options.json)
    fmt::print("{}\n", json_of(object, remarks).dump(2));
  else
    print(object, remarks);
  return 0;
}

}  // namespace

void add_mesh_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "mesh", "Checks an object from a file: triangles, closed or open, size, volume, repairs; needs no device");
  const auto options = std::make_shared<MeshOptions>();
  command->add_option("FILE", options->file, "Object: STL, OBJ, PLY, glTF 2 (.gltf, .glb) or VRML97 (.wrl, .wrl.gz)")
      ->required()
      ->check(not_empty());
  std::vector<std::string> units;
  for (const importer::Unit unit : importer::all_units) units.emplace_back(importer::symbol_of(unit));
  command
      ->add_option("--unit", options->unit,
                   "Unit of the lengths in FILE. Default: the unit of the file, or a suitable one")
      ->check(CLI::IsMember(units));
  command->add_option("--scale", options->scale, "Factor for all lengths (1)")
      ->type_name("FACTOR")
      ->check(more_than_zero());
  add_examples(*command, "inkwell mesh skull.stl\ninkwell mesh gear.wrl --unit mm --json",
               "The workspace is that of the Omni, or of --arm FILE. --json prints JSON for programs.");
  command->callback([context, options] {
    context.action = [options, &device_options = context.device] { return report_mesh(device_options, *options); };
  });
}

}  // namespace inkwell::command_line
