// Keeps the computer from sleeping while a hand feels a force: a suspended computer sends no sign of life, and the
// board would raise a fault.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include <process/fork.hpp>

namespace inkwell::device {

/// One inhibitor of logind, held by the program systemd-inhibit. Without that program, and if logind refuses the
/// request, the computer may sleep. The inhibitor ends with the process, however the process ends.
class SleepInhibitor {
 public:
  SleepInhibitor() = default;
  /// Releases the inhibitor. A forked child leaves its parent's inhibitor alone.
  ~SleepInhibitor();
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;

  /// Starts the thread that follow() needs. The first call only; any thread may call.
  void prepare();
  /// Acquires or releases the inhibitor soon. Never waits; any thread may call. No effect before prepare() and in a
  /// forked child.
  void follow(bool is_wanted) { request(is_wanted ? Request::hold : Request::release); }

 private:
  enum class Request : int { release, hold, end };
  void request(Request request);
  void serve();

  const process::Origin origin_;
  std::atomic<Request> request_ = Request::release;
  std::once_flag is_prepared_;
  std::unique_ptr<std::thread> thread_;
};

}  // namespace inkwell::device
