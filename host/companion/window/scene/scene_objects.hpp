// The objects of the scene: their newest placements, and their meshes in the form for drawing.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <glm/glm.hpp>

#include "host/companion/window/frame/picture_digest.hpp"
#include "host/companion/window/scene/drawn_mesh.hpp"
#include "host/companion/window/scene/shown_object.hpp"

namespace inkwell::window {

/// The drawn form of a mesh. A thread sets `drawn` before `is_done`.
struct MeshPreparation {
  std::uint64_t number;   ///< different for each mesh
  std::size_t triangles;  ///< of the original mesh
  DrawnMesh drawn = {};
  std::atomic<bool> is_done = false;
};

/// Prepares meshes in a thread, because large meshes take seconds.
class MeshPreparer {
 public:
  MeshPreparer();

  std::shared_ptr<const MeshPreparation> start(std::shared_ptr<const geometry::Mesh> mesh);
  /// Count of finished preparations.
  std::uint64_t finished() const { return finished_; }

 private:
  struct Task {
    std::weak_ptr<MeshPreparation> preparation;  ///< expired if the mesh is no longer shown
    std::shared_ptr<const geometry::Mesh> mesh;
  };

  void run(const std::stop_token& stop);

  std::uint64_t newest_number_ = 0;
  std::atomic<std::uint64_t> finished_ = 0;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Task> waiting_;
  std::jthread thread_;  ///< last member, because the thread uses all members above
};

/// An object at its drawn placement, in workspace axes.
struct SceneObject {
  std::shared_ptr<const MeshPreparation> preparation;  ///< never null
  glm::vec3 position_m;
  glm::quat rotation;
  bool is_ready;  ///< the preparation was finished when the frame was laid out

  const DrawnMesh& mesh() const { return preparation->drawn; }
  glm::mat4 to_workspace() const;
};

/// Returns true if the placements or the meshes look different.
bool differs_visibly(std::span<const ShownObject> a, std::span<const ShownObject> b);
bool differs_visibly(std::span<const glm::vec3> a, std::span<const glm::vec3> b);

class SceneObjects {
 public:
  /// Each function may be null.
  SceneObjects(std::function<std::vector<ShownObject>()> objects,
               std::function<std::vector<glm::vec3>()> contact_points_m,
               std::function<ObjectLoading()> loading = nullptr);

  /// Returns true if follow() would change the picture.
  bool has_changed() const;
  /// Adopts the newest placements and the finished meshes. Returns true if the picture changes. If `is_hidden` is true,
  /// the scene has no objects.
  bool follow(bool is_hidden = false);

  const std::vector<SceneObject>& objects() const { return scene_; }
  const std::vector<glm::vec3>& contact_points_m() const { return contact_points_m_; }
  /// Corners of a box around all drawn objects, in workspace axes; empty without such objects.
  std::optional<geometry::Box> box() const;
  /// Changes when the set of drawn meshes changes.
  std::uint64_t meshes_revision() const { return meshes_revision_; }
  /// Text about the loading of objects, or about the preparation of large meshes; empty if all large meshes are ready.
  std::string progress() const;
  /// Sentences about an object that cannot be used; empty: none.
  const std::string& problem() const { return loading_.problem; }
  /// Adds meshes and placements, but not the contact points, which are labels.
  void add_to(PictureDigest& digest) const;

 private:
  std::vector<ShownObject> newest_objects() const;
  std::vector<glm::vec3> newest_contact_points_m() const;
  ObjectLoading newest_loading() const;
  void place(std::vector<ShownObject> objects);

  std::function<std::vector<ShownObject>()> objects_source_;
  std::function<std::vector<glm::vec3>()> contact_points_source_;
  std::function<ObjectLoading()> loading_source_;
  std::vector<ShownObject> shown_;  ///< the source of `scene_`
  std::vector<SceneObject> scene_;
  std::vector<glm::vec3> contact_points_m_;
  ObjectLoading loading_;
  std::uint64_t meshes_revision_ = 0;
  std::uint64_t seen_finished_ = 0;
  MeshPreparer preparer_;
};

}  // namespace inkwell::window
