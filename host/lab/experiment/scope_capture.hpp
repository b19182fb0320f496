// Scope data during an experiment.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host/client/recording/recording.hpp"
#include "host/lab/experiment/paced_device.hpp"

namespace inkwell::experiment {

/// Reads the selected signals on a separate thread.
class ScopeCapture {
 public:
  ScopeCapture(PacedDevice& device, const recording::Information& information);
  ~ScopeCapture();
  ScopeCapture(const ScopeCapture&) = delete;
  ScopeCapture& operator=(const ScopeCapture&) = delete;

  std::size_t size() const;
  /// Waits for the first `samples` samples, returns them and releases the scope. Throws device::Error if samples do not
  /// arrive or are lost.
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
