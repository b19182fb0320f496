#include "errors.hpp"

#include <deque>
#include <map>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include <process/fork.hpp>

namespace inkwell::dropins {
namespace {

constexpr std::size_t stack_maximum = 256;
/// Of texts that are kept for ever. Sentences differ by device and cause, so that a program meets a handful.
constexpr std::size_t kept_maximum = 1024;

struct Text {
  ErrorCode code;
  const char* name;
  const char* sentence;
};

constexpr Text texts[] = {
    {success, "HD_SUCCESS", "No error."},
    {invalid_enum, "HD_INVALID_ENUM", "The call does not take this constant. Check the constant's name."},
    {invalid_value, "HD_INVALID_VALUE", "The value is outside of what the call takes. Give one in its range."},
    {invalid_operation, "HD_INVALID_OPERATION", "This can not be done now. Check the order of the calls."},
    {invalid_input_type, "HD_INVALID_INPUT_TYPE", "The parameter has another type. Use the call for its type."},
    {bad_handle, "HD_BAD_HANDLE", "No device is open under this handle. Use what hdInitDevice() returned."},
    {warm_motors, "HD_WARM_MOTORS",
     "The motors are warm, and the force may be held back. Ask for less force for a while."},
    {exceeded_max_force, "HD_EXCEEDED_MAX_FORCE", "The force is larger than the arm's. It is off and comes back."},
    {exceeded_max_force_impulse, "HD_EXCEEDED_MAX_FORCE_IMPULSE", "The force changes faster than is allowed."},
    {exceeded_max_velocity, "HD_EXCEEDED_MAX_VELOCITY", "The stylus is too fast. The force is off and comes back."},
    {force_error, "HD_FORCE_ERROR", "The arm can not give this force. Ask for a force or for motor values, not both."},
    {device_fault, "HD_DEVICE_FAULT", "The device does not work. Run `inkwell info`."},
    {device_already_initiated, "HD_DEVICE_ALREADY_INITIATED", "The device is open. Disable it before it is opened."},
    {comm_error, "HD_COMM_ERROR", "The link to the device is lost. Check its cable, then open it again."},
    {comm_config_error, "HD_COMM_CONFIG_ERROR", "The link to the device is not set up. Run `inkwell info`."},
    {timer_error, "HD_TIMER_ERROR", "The scheduler can not be started. Check how many threads are allowed."},
    {illegal_begin, "HD_ILLEGAL_BEGIN", "A frame is open already, or was in this tick. End it, one in each tick."},
    {illegal_end, "HD_ILLEGAL_END", "No frame is open. Begin one first."},
    {frame_error, "HD_FRAME_ERROR", "This is only allowed between hdBeginFrame() and hdEndFrame()."},
    {invalid_priority, "HD_INVALID_PRIORITY", "The priority is not between 0 and 65535."},
    {scheduler_full, "HD_SCHEDULER_FULL", "The scheduler has as many callbacks as it can take. Unschedule some."},
    {invalid_license, "HD_INVALID_LICENSE", "There is no such licence, and none is needed."},
};

std::mutex stack_mutex;
const process::HeldAtFork stack_at_fork(stack_mutex);

struct Stack {
  std::deque<ErrorInfo> errors;
  std::map<unsigned, std::string> sentences;  ///< the newest of each code
  std::set<std::string> kept;
};

/// Lives until the process ends: programs ask for errors in their last destructors.
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

bool forget_errors_of(Handle device, ErrorCode looked_for) {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  bool was_there = false;
  std::erase_if(self.errors, [&](const ErrorInfo& error) {
    was_there = was_there || (error.device == device && error.code == looked_for);
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
  return "This is not a code of HDAPI's errors.";
}

const char* keep(const std::string& text) {
  auto& self = stack();
  const std::lock_guard lock(stack_mutex);
  if (const auto found = self.kept.find(text); found != self.kept.end()) return found->c_str();
  if (self.kept.size() == kept_maximum) return "The reason is not kept any more: there were too many.";
  return self.kept.insert(text).first->c_str();
}

}  // namespace inkwell::dropins
