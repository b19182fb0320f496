#include "host/lab/campaign/model_faults.hpp"

#include <cmath>
#include <optional>

namespace inkwell::campaign {
namespace {

constexpr double interval_s = 0.001;

/// A floor above the tip.
device::LocalModel floor_above(const device::Pose& pose, float height_m) {
  device::LocalModel model;
  for (std::size_t axis = 0; axis < 3; ++axis) model.anchor_m[axis] = pose.position_m[axis];
  model.features[0].point_m = model.anchor_m;
  model.features[0].point_m[2] += height_m;
  model.count = 1;
  return model;
}

/// One of four models: a floor, a higher floor, a ceiling and a leaning wall.
device::LocalModel contradiction(const device::LocalModel& floor, unsigned number) {
  constexpr float step_m = 0.005f;
  device::LocalModel model = floor;
  device::Feature& feature = model.features[0];
  switch (number % 4) {
    case 1: feature.point_m[2] += step_m; break;
    case 2: feature.direction = {0.0f, 0.0f, -1.0f}; break;
    case 3: feature.direction = {0.6f, 0.0f, 0.8f}; break;
    default: break;
  }
  return model;
}

}  // namespace

void run_with_models(BoardRun& board, Deed deed, double duration_s) {
  constexpr float height_m = 0.001f;
  constexpr int missing_material = protocol::materials_maximum - 1;
  constexpr std::uint32_t old_poses = 200;
  device::Shapes materials;
  materials.materials = {{1000, 2, 0.4f, 0.3f, 0}};
  board.place(materials);
  std::optional<device::LocalModel> floor;
  const auto reports = static_cast<unsigned>(std::lround(duration_s / interval_s));
  for (unsigned i = 0; i < reports; ++i) {
    if (board.pose() && !floor) floor = floor_above(*board.pose(), height_m);
    const bool is_wrong = 3 * i >= reports;
    if (board.pose() && !(is_wrong && deed == Deed::models_lost)) {
      device::LocalModel model = *floor;
      device::ForceRequest force{.mode = protocol::ForceMode::beside_walls};
      if (is_wrong && deed == Deed::models_stale)
        force.pose_sequence = static_cast<std::uint32_t>(board.pose()->sequence) - old_poses;
      if (is_wrong && deed == Deed::models_malformed) model.features[0].material = missing_material;
      if (is_wrong && deed == Deed::models_contradictory) model = contradiction(*floor, i);
      board.send(model, force);
    }
    board.run(interval_s, false);
  }
}

}  // namespace inkwell::campaign
