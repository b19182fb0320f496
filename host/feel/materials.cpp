#include "host/feel/materials.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace inkwell::feel {
namespace {

// Properties: stiffness in N/m, damping in Ns/m, static friction, dynamic friction, viscosity in Ns/m. The stiffness is
// far below that of the real materials, because the arm reaches its force limit after a few millimeters anyway. The
// differences between the materials are chosen for the hand.
constexpr std::array<NamedMaterial, 9> list = {{
    {"wood", {1000, 2, 0.45f, 0.3f, 0}},
    {"rubber", {500, 3, 1.0f, 0.8f, 0}},
    {"glass", {1500, 1, 0.12f, 0.08f, 0}},
    {"steel", {1800, 1, 0.25f, 0.18f, 0}},
    {"stone", {1500, 2, 0.7f, 0.5f, 0}},
    {"ice", {1200, 0, 0.04f, 0.02f, 0}},
    {"skin", {250, 2, 0.5f, 0.4f, 1}},
    {"sponge", {120, 3, 0.8f, 0.6f, 2}},
    {"smooth", {800, 2, 0, 0, 0}},
}};

}  // namespace

std::span<const NamedMaterial> materials() { return list; }

const NamedMaterial* find_material(std::string_view name) {
  const auto found = std::ranges::find(list, name, &NamedMaterial::name);
  return found == list.end() ? nullptr : &*found;
}

std::string material_names() {
  std::array<std::string_view, list.size()> names;
  std::ranges::transform(list, names.begin(), &NamedMaterial::name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace inkwell::feel
