#include "host/companion/command_line/awaited_object.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace inkwell::command_line {

AwaitedObject::AwaitedObject(feel::Loading& loading, std::function<void(const feel::LoadedObject&)> on_loaded)
    : loading_(loading), on_loaded_(std::move(on_loaded)) {}

window::ObjectLoading AwaitedObject::follow() {
  if (object_ || !problem_.empty()) return {.problem = problem_};
  if (!loading_.is_done_within(std::chrono::milliseconds(0)))
    return {.progress = fmt::format("{}, {:.0f} %", loading_.step(), 100 * loading_.progress())};
  try {
    object_ = loading_.take();
    on_loaded_(*object_);
  } catch (const importer::Error& error) {
    problem_ = error.what();
  }
  return {.problem = problem_};
}

}  // namespace inkwell::command_line
