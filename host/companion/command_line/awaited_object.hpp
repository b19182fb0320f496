// An object that is loaded while the window is open.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "host/companion/window/window_options.hpp"
#include "host/feel/loading.hpp"

namespace inkwell::command_line {

/// Only one thread uses this object.
class AwaitedObject {
 public:
  /// `on_loaded` is called once, by follow().
  AwaitedObject(feel::Loading& loading, std::function<void(const feel::LoadedObject&)> on_loaded);

  /// Adopts the object when it is loaded. Returns the state for the window.
  window::ObjectLoading follow();

  const std::optional<feel::LoadedObject>& object() const { return object_; }
  const std::string& problem() const { return problem_; }  ///< sentences; empty: none so far

 private:
  feel::Loading& loading_;
  std::function<void(const feel::LoadedObject&)> on_loaded_;
  std::optional<feel::LoadedObject> object_;
  std::string problem_;
};

}  // namespace inkwell::command_line
