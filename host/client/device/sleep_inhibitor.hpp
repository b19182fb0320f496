// Prevents computer sleep while the force is on. A sleeping computer sends no heartbeats, so the board would raise a
// fault.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "host/client/process/fork.hpp"

namespace inkwell::device {

/// Runs the program systemd-inhibit. The computer may still sleep if that program is missing or logind refuses the
/// request. The computer may sleep again when this process exits.
class SleepInhibitor {
 public:
  SleepInhibitor() = default;
  /// Releases the inhibitor, except in a forked child.
  ~SleepInhibitor();
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;

  /// Starts the thread for follow(). Later calls have no effect. Any thread may call this function.
  void prepare();
  /// Acquires or releases the inhibitor asynchronously. Has no effect before prepare() or in a forked child. Any thread
  /// may call this function.
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
