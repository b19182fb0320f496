// Meshes from the arrays of a program.
#pragma once

#include <memory>

#include <inkwell/inkwell.h>
#include "host/geometry/surface.hpp"

namespace inkwell::library {

/// Reads, repairs and prepares the mesh in the calling thread. The surface's faces have the numbers of the program's
/// triangles. Throws BadArgument with a sentence about the wrong value.
std::shared_ptr<const geometry::Surface> surface_of_arrays(const inkwell_mesh& mesh);

}  // namespace inkwell::library
