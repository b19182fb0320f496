// Prevents computer sleep while the force is on. A suspended computer would send no sign of life, and the board would
// raise a fault.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "host/client/process/fork.hpp"

namespace inkwell::device {

/// One logind inhibitor, held by the program systemd-inhibit. If that program is missing or logind refuses, the
/// computer may sleep. The inhibitor is released whenever the process exits.
class SleepInhibitor {
 public:
  SleepInhibitor() = default;
  /// Releases the inhibitor. A forked child does not release the parent's inhibitor.
  ~SleepInhibitor();
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;

  /// Starts the thread that follow() needs. Only the first call has an effect. Any thread may call this function.
  void prepare();
  /// Acquires or releases the inhibitor asynchronously. Any thread may call this function. Has no effect before
  /// prepare() was called, or in a forked child.
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
