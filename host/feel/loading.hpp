// Loads an object for the hand.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/contact/scene.hpp"
#include "host/geometry/repair.hpp"
#include "host/geometry/surface.hpp"
#include "host/import/import.hpp"

namespace inkwell::feel {

struct LoadRequest {
  std::filesystem::path file;  ///< ignored if `example` is not empty
  std::string example;         ///< name of a geometry::Example
  std::optional<importer::Unit> unit{};
  double scale = 1;     ///< factor for all lengths; positive
  bool is_fit = false;  ///< scale the object to the workspace
  geometry::Box workspace;
};

/// An object whose middle is in the middle of the workspace.
struct LoadedObject {
  std::string name;
  std::shared_ptr<const geometry::Surface> surface;
  contact::Placement placement;
  geometry::Measurements measurements;  ///< after scaling
  std::string unit_text;                ///< unit of the file and its source; empty for an example
  std::vector<std::string> remarks;     ///< sentences for the user
};

/// @throws importer::Error if the object cannot be used, if its size does not suit the workspace, or if `progress`
/// cancels the work.
LoadedObject load_object(const LoadRequest& request, const importer::Progress& progress = {});

/// Loads an object in a thread of its own. The destructor cancels the work.
class Loading {
 public:
  explicit Loading(LoadRequest request);
  ~Loading();
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  double progress() const { return progress_; }  ///< 0 to 1
  /// The object and the present step, such as "loading skull.stl: reading the mesh".
  std::string step() const;
  bool is_done_within(std::chrono::milliseconds time) const;
  void cancel() { is_canceled_ = true; }
  /// Waits for the object. Call this function once. @throws importer::Error as load_object().
  LoadedObject take() { return loaded_.get(); }

 private:
  std::string name_;
  std::atomic<double> progress_ = 0;
  std::atomic<bool> is_canceled_ = false;
  std::future<LoadedObject> loaded_;
};

}  // namespace inkwell::feel
