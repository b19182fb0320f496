// The thread that reads the scope: for who asks for samples, and into a recording.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <device/device.hpp>
#include <recording/recorder.hpp>

#include "pose_feed.hpp"

namespace inkwell::library {

class ScopeStream {
 public:
  /// Ends `poses` if the device is gone, and ends with them.
  ScopeStream(device::Device& device, PoseFeed& poses);
  ~ScopeStream();

  /// Throws NotNow during a recording.
  void select(const std::vector<protocol::Signal>& signals);
  /// At most `capacity` samples of those that came; none on time-out. Throws NotNow if no signals are selected.
  std::optional<device::ScopeSamples> read(double timeout_s, std::size_t capacity);

  /// Throws NotNow if no signals are selected or a recording runs.
  void start_recording(const std::string& path, bool is_simulation);
  /// Throws NotNow if none runs, and Error if the file could not be written.
  recording::RecorderStatus stop_recording();

 private:
  void run();
  void keep(device::ScopeSamples samples);

  device::Device& device_;
  PoseFeed& poses_;

  std::mutex user_mutex_;  ///< one at a time selects, starts and stops; taken before `mutex_`

  std::mutex mutex_;  ///< guards the following; never held while the device or a file is waited for
  std::condition_variable changed_;
  std::vector<protocol::Signal> signals_;
  std::deque<device::ScopeSamples> samples_;  ///< not read yet
  std::size_t rows_kept_ = 0;
  std::unique_ptr<recording::Recorder> recorder_;  ///< changed by who has `user_mutex_` as well
  bool stops_ = false;

  std::thread thread_;
};

}  // namespace inkwell::library
