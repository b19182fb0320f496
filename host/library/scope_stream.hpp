// The thread that reads the scope: for who asks for samples, and into a recording.
#pragma once

#include <atomic>
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

/// In lock step it has no thread: the samples that come before a pose are read with it.
class ScopeStream : private TurnPart {
 public:
  ScopeStream(device::Device& device, PoseFeed& poses);
  ~ScopeStream();

  /// Throws NotNow during a recording.
  void select(const std::vector<protocol::Signal>& signals);
  /// At most `capacity` samples of those that came; none on time-out. Throws NotNow if no signals are selected, and
  /// Disconnected once a loss of the link has ended the selection.
  std::optional<device::ScopeSamples> read(double timeout_s, std::size_t capacity);

  /// Throws NotNow if no signals are selected or a recording runs.
  void start_recording(const std::string& path, bool is_simulation);
  /// Throws NotNow if none runs, and Error if the file could not be written.
  recording::RecorderStatus stop_recording();

 private:
  void after_pose() override;
  void lose_link(const std::string& cause) override;
  void run();
  void keep(device::ScopeSamples samples);
  void end(std::uint64_t selection, const std::string& cause);
  /// With the mutex held; without it in between.
  void wait_for_samples(std::unique_lock<std::mutex>& lock, double timeout_s);
  /// With no selection the reason why the last one is over is forgotten.
  bool is_selected();

  device::Device& device_;
  PoseFeed& poses_;

  std::mutex user_mutex_;  ///< one at a time selects, starts and stops; taken before `mutex_`

  std::mutex mutex_;  ///< guards the following; never held while the device or a file is waited for
  std::condition_variable changed_;
  std::atomic<std::uint64_t> selection_ = 0;  ///< so many have been made or have ended; may be read likewise
  std::vector<protocol::Signal> signals_;
  std::string ended_by_;                           ///< why the selection is over, empty if the program ended it
  std::deque<device::ScopeSamples> samples_;       ///< not read yet
  std::atomic<std::size_t> rows_kept_ = 0;         ///< may be read without the mutex
  std::unique_ptr<recording::Recorder> recorder_;  ///< changed by who has `user_mutex_` as well
  bool stops_ = false;

  std::thread thread_;
};

}  // namespace inkwell::library
