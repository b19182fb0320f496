// Local models approximate a large object near the tip. The PC computes them from a mesh at 1 kHz, and the board
// renders them at the servo rate (Adachi, Kumano, Ogino, "Intermediate representation for stiff virtual objects", VRAIS
// 1995).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/signal_path/solid.hpp"
#include "firmware/control/signal_path/surface.hpp"
#include "protocol/reports.hpp"

namespace inkwell::control {

/// A face, an edge or a corner of an object, as a surface that the center of the tip cannot pass.
struct Feature {
  Solid solid;
  Surface surface;
  Vector3 velocity_m_per_s;  ///< of `solid.centre_m`; 0 for a stationary object
  Vector3 axis_rate_per_s;   ///< change of `solid.axes[0]` by the rotation of the object
  /// The surface is this far below its final position. The surface moves outward slowly.
  float recess_m = 0.0f;
};

struct LocalModel {
  /// Largest speed at which a surface under the tip moves to its final position.
  static constexpr float recovery_m_per_s = 0.1f;

  std::array<Feature, protocol::local_features_maximum> features{};
  std::size_t count = 0;
  std::uint32_t life_periods = 0;  ///< time until the model expires without a new model
};

}  // namespace inkwell::control
