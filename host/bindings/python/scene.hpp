// Shapes and scenes for the Python files of the package.
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

#include "host/bindings/python/arm.hpp"

namespace inkwell::python {

/// Places Python shape objects from inkwell/shapes.py.
void place_shapes(Arm& arm, const py::list& planes, const py::list& solids);

/// Position, quaternion (x, y, z, w), velocity and angular velocity.
using PlacementTuple = std::tuple<Vector, std::array<double, 4>, Vector, Vector>;
/// Stiffness, damping, static and dynamic friction, viscosity.
using MaterialTuple = std::array<double, 5>;

/// `vertices` and `triangles` are C-contiguous arrays with shape (n, 3), or None. The arrays are not copied.
std::uint32_t scene_add(Arm& arm, int shape, const Vector& size_m, const py::object& vertices,
                        const py::object& triangles, const PlacementTuple& placement, const MaterialTuple& material,
                        bool is_smooth);
void scene_move(Arm& arm, std::uint32_t number, const PlacementTuple& placement);
void scene_set_material(Arm& arm, std::uint32_t number, const MaterialTuple& material);
void scene_remove(Arm& arm, std::uint32_t number);
void scene_clear(Arm& arm);
std::vector<inkwell_contact> scene_contacts(Arm& arm);
/// (events, number of lost events)
std::pair<std::vector<inkwell_event>, std::uint64_t> scene_events(Arm& arm);

void define_scene(py::module_& module);

}  // namespace inkwell::python
