// What the scope sends while an experiment goes on.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <experiment/paced_device.hpp>
#include <recording/recording.hpp>

namespace inkwell::experiment {

/// Asks for signals, and reads them in a thread of its own for as long as it lives.
class ScopeCapture {
 public:
  ScopeCapture(PacedDevice& device, const recording::Information& information);
  ~ScopeCapture();
  ScopeCapture(const ScopeCapture&) = delete;
  ScopeCapture& operator=(const ScopeCapture&) = delete;

  std::size_t size() const;
  /// The first `samples` samples, once they are there; gives the scope back. Throws device::Error if they do not come,
  /// or if some are lost.
  recording::Recording take(std::size_t samples);

 private:
  void check() const;

  PacedDevice& device_;
  mutable std::mutex mutex_;
  recording::Recording recording_;
  std::optional<std::string> failure_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace inkwell::experiment
