// Transfer of scenes from an editing thread to the servo thread.
#pragma once

#include <atomic>
#include <memory>

#include "host/contact/scene.hpp"

namespace inkwell::contact {

/// The newest scene. One servo thread calls latest(); one editing thread at a time calls publish() and free_retired().
/// latest() is a fixed number of atomic operations: it does not lock, wait, allocate or free. It puts the previous
/// scene on a list, and the editing thread frees the list in its next call.
class Publication {
 public:
  Publication() = default;
  Publication(const Publication&) = delete;
  Publication& operator=(const Publication&) = delete;
  /// The servo thread must have ended.
  ~Publication();

  /// Replaces the scene, and frees the scenes that the servo thread has returned. The scene must not be null.
  void publish(std::shared_ptr<const Scene> scene);
  /// Frees the scenes that the servo thread has returned. Call this after the last publish() to free memory early.
  void free_retired();

  /// Servo thread: the newest scene, or nullptr before the first publish(). The scene is valid until the next call.
  const Scene* latest();

 private:
  struct Entry {
    std::shared_ptr<const Scene> scene;
    Entry* next = nullptr;
  };
  static void free_list(Entry* entry);

  std::atomic<Entry*> pending_{nullptr};  ///< published, not yet used
  Entry* current_ = nullptr;              ///< only for the servo thread
  /// Returned by the servo thread: a list, newest entry first.
  std::atomic<Entry*> retired_{nullptr};
};

}  // namespace inkwell::contact
