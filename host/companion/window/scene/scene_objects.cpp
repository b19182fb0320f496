#include "host/companion/window/scene/scene_objects.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <utility>

#include <fmt/format.h>

namespace inkwell::window {

namespace {

constexpr float visible_m = 2e-4f;
constexpr float visible_rad = 2e-3f;  // 0.2 mm at the border of an object of 0.2 m

bool is_moved(glm::vec3 a_m, glm::vec3 b_m) { return !(glm::length(a_m - b_m) <= visible_m); }

bool is_turned(const glm::quat& a, const glm::quat& b) {
  // The imaginary part of the difference has half of the angle as its length.
  const glm::quat difference = glm::conjugate(a) * b;
  return !(2.0f * glm::length(glm::vec3{difference.x, difference.y, difference.z}) <= visible_rad);
}

bool is_finite(glm::vec3 point_m) { return std::isfinite(point_m.x + point_m.y + point_m.z); }

bool is_finite(const glm::quat& turn) { return std::isfinite(turn.x + turn.y + turn.z + turn.w); }

}  // namespace

MeshPreparer::MeshPreparer() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::shared_ptr<const MeshPreparation> MeshPreparer::start(std::shared_ptr<const geometry::Mesh> mesh) {
  const std::shared_ptr<MeshPreparation> preparation(new MeshPreparation{++newest_number_, mesh->faces.size()});
  {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back({preparation, std::move(mesh)});
  }
  changed_.notify_one();
  return preparation;
}

void MeshPreparer::run(const std::stop_token& stop) {
  for (;;) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return !waiting_.empty(); }) || stop.stop_requested()) return;
      task = std::move(waiting_.front());
      waiting_.pop_front();
    }
    const std::shared_ptr<MeshPreparation> preparation = task.preparation.lock();
    if (!preparation) continue;
    try {
      preparation->drawn = make_drawn_mesh(*task.mesh);
    } catch (const std::bad_alloc&) {
      preparation->drawn = {};  // the object is felt but not drawn
    }
    preparation->is_done = true;
    ++finished_;
  }
}

glm::mat4 SceneObject::to_workspace() const {
  glm::mat4 matrix = glm::mat4_cast(rotation);
  matrix[3] = glm::vec4{position_m, 1.0f};
  return matrix;
}

bool differs_visibly(std::span<const ShownObject> a, std::span<const ShownObject> b) {
  return !std::ranges::equal(a, b, [](const ShownObject& one, const ShownObject& other) {
    return one.mesh == other.mesh && !is_moved(one.position_m, other.position_m) &&
           !is_turned(one.rotation, other.rotation);
  });
}

bool differs_visibly(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
  return !std::ranges::equal(a, b, [](glm::vec3 one, glm::vec3 other) { return !is_moved(one, other); });
}

SceneObjects::SceneObjects(std::function<std::vector<ShownObject>()> objects,
                           std::function<std::vector<glm::vec3>()> contact_points_m,
                           std::function<ObjectLoading()> loading)
    : objects_source_(std::move(objects)),
      contact_points_source_(std::move(contact_points_m)),
      loading_source_(std::move(loading)) {}

std::vector<ShownObject> SceneObjects::newest_objects() const {
  std::vector<ShownObject> objects;
  if (objects_source_) objects = objects_source_();
  std::erase_if(objects, [](const ShownObject& object) {
    return !object.mesh || !is_finite(object.position_m) || !is_finite(object.rotation);
  });
  return objects;
}

std::vector<glm::vec3> SceneObjects::newest_contact_points_m() const {
  std::vector<glm::vec3> points_m;
  if (contact_points_source_) points_m = contact_points_source_();
  std::erase_if(points_m, [](glm::vec3 point_m) { return !is_finite(point_m); });
  return points_m;
}

ObjectLoading SceneObjects::newest_loading() const { return loading_source_ ? loading_source_() : ObjectLoading{}; }

bool SceneObjects::has_changed() const {
  return preparer_.finished() != seen_finished_ || newest_loading() != loading_ ||
         differs_visibly(shown_, newest_objects()) || differs_visibly(contact_points_m_, newest_contact_points_m());
}

void SceneObjects::place(std::vector<ShownObject> objects) {
  std::vector<SceneObject> scene;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ShownObject& object = objects[i];
    const auto index_of_mesh = [&object](const auto begin, const auto end) {
      return std::find_if(begin, end, [&](const ShownObject& other) { return other.mesh == object.mesh; }) - begin;
    };
    const auto before = static_cast<std::size_t>(index_of_mesh(shown_.begin(), shown_.end()));
    const auto same =
        static_cast<std::size_t>(index_of_mesh(objects.begin(), objects.begin() + static_cast<std::ptrdiff_t>(i)));
    const auto preparation = before < shown_.size() ? scene_[before].preparation
                             : same < i             ? scene[same].preparation
                                                    : preparer_.start(object.mesh);
    scene.push_back({preparation, object.position_m, object.rotation, false});
  }
  shown_ = std::move(objects);
  scene_ = std::move(scene);
}

bool SceneObjects::follow(bool is_hidden) {
  seen_finished_ = preparer_.finished();
  ObjectLoading loading = is_hidden ? ObjectLoading{} : newest_loading();
  const bool has_loaded = std::exchange(loading_, std::move(loading)) != loading_;
  std::vector<ShownObject> objects = is_hidden ? std::vector<ShownObject>{} : newest_objects();
  std::vector<glm::vec3> points_m = is_hidden ? std::vector<glm::vec3>{} : newest_contact_points_m();
  const bool has_moved = differs_visibly(shown_, objects);
  const bool has_new_points = differs_visibly(contact_points_m_, points_m);
  const auto drawn_meshes = [this] {
    std::vector<std::uint64_t> numbers;
    for (const SceneObject& object : scene_)
      if (object.is_ready) numbers.push_back(object.preparation->number);
    return numbers;
  };
  const std::vector<std::uint64_t> drawn_before = drawn_meshes();
  if (has_moved) place(std::move(objects));
  if (has_new_points) contact_points_m_ = std::move(points_m);
  for (SceneObject& object : scene_) object.is_ready = object.preparation->is_done;
  const bool has_new_meshes = drawn_meshes() != drawn_before;
  if (has_new_meshes) ++meshes_revision_;
  return has_moved || has_new_points || has_new_meshes || has_loaded;
}

std::optional<geometry::Box> SceneObjects::box() const {
  std::optional<geometry::Box> all;
  for (const SceneObject& object : scene_) {
    if (!object.is_ready || object.mesh().indices.empty()) continue;
    const auto& [minimum_m, maximum_m] = object.mesh().box;
    if (!all) all.emplace();
    for (unsigned corner = 0; corner < 8; ++corner) {
      const glm::vec3 of_mesh_m{(corner & 1) != 0 ? maximum_m.x : minimum_m.x,
                                (corner & 2) != 0 ? maximum_m.y : minimum_m.y,
                                (corner & 4) != 0 ? maximum_m.z : minimum_m.z};
      const glm::vec3 corner_m = object.position_m + object.rotation * of_mesh_m;
      all->minimum_m = glm::min(all->minimum_m, corner_m);
      all->maximum_m = glm::max(all->maximum_m, corner_m);
    }
  }
  return all;
}

std::string SceneObjects::progress() const {
  if (!loading_.progress.empty()) return loading_.progress;
  std::size_t triangles = 0;
  for (const SceneObject& object : scene_)
    if (!object.is_ready && object.preparation->triangles > drawn_triangles_max)
      triangles += object.preparation->triangles;
  return triangles == 0 ? "" : fmt::format("Preparing the picture of {} triangles...", triangles);
}

void SceneObjects::add_to(PictureDigest& digest) const {
  for (const SceneObject& object : scene_) {
    if (!object.is_ready) continue;
    digest.add(object.preparation->number);
    digest.add_bytes(&object.position_m, sizeof object.position_m);
    digest.add_bytes(&object.rotation, sizeof object.rotation);
  }
}

}  // namespace inkwell::window
