#include "host/bindings/dropins/errors.hpp"

#include <deque>
#include <map>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include "host/client/process/fork.hpp"

namespace inkwell::dropins {
namespace {

constexpr std::size_t stack_maximum = 256;
/// Stored texts are never freed, so this number limits the stored texts.
constexpr std::size_t kept_maximum = 1024;

struct Text {
  ErrorCode code;
  const char* name;
  const char* sentence;
};

constexpr Text texts[] = {
    {success, "HD_SUCCESS", "No error."},
    {invalid_enum, "HD_INVALID_ENUM", "The call does not accept this constant. Check the constant's name."},
    {invalid_value, "HD_INVALID_VALUE", "The value is outside the range of the call. Give a value in its range."},
    {invalid_operation, "HD_INVALID_OPERATION",
     "This call is not possible in the present state. Check the order of the calls."},
    {invalid_input_type, "HD_INVALID_INPUT_TYPE", "The parameter has another type. Use the call for its type."},
    {bad_handle, "HD_BAD_HANDLE", "No device is open with this handle. Use the handle that hdInitDevice() returned."},
    {warm_motors, "HD_WARM_MOTORS",
     "The motors are warm, and the force may be reduced. Request less force for a while."},
    {exceeded_max_force, "HD_EXCEEDED_MAX_FORCE",
     "The requested force exceeds the arm's limit. The force is off and returns by itself."},
    {exceeded_max_force_impulse, "HD_EXCEEDED_MAX_FORCE_IMPULSE",
     "The force changes faster than the limit allows. Change it more slowly."},
    {exceeded_max_velocity, "HD_EXCEEDED_MAX_VELOCITY",
     "The stylus is too fast. The force is off and returns by itself."},
    {force_error, "HD_FORCE_ERROR", "The arm cannot apply this force. Request either a force or motor values."},
    {device_fault, "HD_DEVICE_FAULT", "The device does not work. Run `inkwell info`."},
    {device_already_initiated, "HD_DEVICE_ALREADY_INITIATED",
     "The device is already open. Disable it before you open it again."},
    {comm_error, "HD_COMM_ERROR", "The link to the device is lost. Check its cable, then open it again."},
    {comm_config_error, "HD_COMM_CONFIG_ERROR", "The link to the device is not set up. Run `inkwell info`."},
    {timer_error, "HD_TIMER_ERROR", "The scheduler cannot be started. Check how many threads are allowed."},
    {illegal_begin, "HD_ILLEGAL_BEGIN",
     "A frame is already open, or this tick had one. End the frame, and begin one per tick."},
    {illegal_end, "HD_ILLEGAL_END", "No frame is open. Begin one first."},
    {frame_error, "HD_FRAME_ERROR", "This call is only allowed between hdBeginFrame() and hdEndFrame()."},
    {invalid_priority, "HD_INVALID_PRIORITY", "The priority is not between 0 and 65535. Give one in this range."},
    {scheduler_full, "HD_SCHEDULER_FULL", "The scheduler has its maximum number of callbacks. Unschedule some."},
    {invalid_license, "HD_INVALID_LICENSE", "There is no such license, and no license is needed."},
};

std::mutex stack_mutex;
const process::HeldAtFork stack_at_fork(stack_mutex);

struct Stack {
  std::deque<ErrorInfo> errors;
  std::map<unsigned, std::string> sentences;  ///< newest sentence per code
  std::set<std::string> kept;
};

/// The stack is never destroyed, because destructors of static objects may read errors.
Stack& stack() {
  static auto& stack = *new Stack;
  return stack;
}

}  // namespace

void raise(ErrorCode code, Handle device, const std::string& sentence, int internal_code) {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  if (self.errors.size() == stack_maximum) self.errors.pop_front();
  self.errors.push_back({code, internal_code, device});
  if (sentence.empty())
    self.sentences.erase(code);
  else
    self.sentences[code] = sentence;
}

ErrorInfo take_error() {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  if (self.errors.empty()) return {success, 0, invalid_handle};
  const auto newest = self.errors.back();
  self.errors.pop_back();
  return newest;
}

bool forget_errors_of(Handle device, ErrorCode wanted) {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  bool was_there = false;
  std::erase_if(self.errors, [&](const ErrorInfo& error) {
    was_there = was_there || (error.device == device && error.code == wanted);
    return error.device == device;
  });
  return was_there;
}

const char* error_text(unsigned code) {
  for (const auto& text : texts) {
    if (text.code != code) continue;
    std::string sentence;
    {
      const std::lock_guard lock(stack_mutex);
      const auto newest = stack().sentences.find(code);
      sentence = newest == stack().sentences.end() ? text.sentence : newest->second;
    }
    return keep(fmt::format("{}: {}", text.name, sentence));
  }
  return "This is not an HDAPI error code.";
}

const char* keep(const std::string& text) {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  if (const auto found = self.kept.find(text); found != self.kept.end()) return found->c_str();
  if (self.kept.size() == kept_maximum) return "The reason is no longer stored: there were too many different reasons.";
  return self.kept.insert(text).first->c_str();
}

}  // namespace inkwell::dropins
