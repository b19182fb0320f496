// Reads scope samples for callers and for a recording.
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

#include "host/client/device/device.hpp"
#include "host/client/recording/event_feed.hpp"
#include "host/client/recording/recorder.hpp"

#include "host/bindings/library/pose_feed.hpp"
#include "host/bindings/library/pose_reports.hpp"

namespace inkwell::library {

/// In lock step, the pose thread reads the samples with each pose.
class ScopeStream : private TurnPart {
 public:
  ScopeStream(device::Device& device, PoseFeed& poses, PoseReports& reports);
  ~ScopeStream();

  /// Throws NotNow during a recording.
  void select(const std::vector<protocol::Signal>& signals);
  /// Returns at most `capacity` samples, or none on time-out. Throws NotNow if no signals are selected, and
  /// Disconnected if a lost link has ended the selection.
  std::optional<device::ScopeSamples> read(double timeout_s, std::size_t capacity);

  /// Throws NotNow if no signals are selected or a recording is running.
  void start_recording(const std::string& path, const protocol::ParameterSet& parameters, bool is_simulation,
                       const recording::Origin& origin);
  /// Throws NotNow if no recording is running, and Error if the file could not be written.
  recording::RecorderStatus stop_recording();
  bool is_recording();
  /// Throws NotNow if no recording is running.
  void mark(const std::string& text);
  /// Notes events in the recording, if a recording is running.
  void note(const std::vector<device::Event>& events);

 private:
  void after_pose() override;
  void lose_link(const std::string& cause) override;
  void run();
  void keep(device::ScopeSamples samples);
  void take_report(const device::Pose& report);
  void end(std::uint64_t selection, const std::string& cause);
  /// `lock` must be locked and is unlocked during the wait.
  void wait_for_samples(std::unique_lock<std::mutex>& lock, double timeout_s);
  /// Returns true if signals are selected. Otherwise the function clears `ended_by_`.
  bool clear_end_reason();

  device::Device& device_;
  PoseFeed& poses_;
  PoseReports& reports_;

  std::mutex user_mutex_;  ///< serializes select, start and stop; locked before `mutex_`

  std::mutex mutex_;  ///< guards the following members; not held during device or file access
  std::condition_variable changed_;
  std::atomic<std::uint64_t> selection_ = 0;  ///< number of selections made and ended; may be read without the mutex
  std::vector<protocol::Signal> signals_;
  std::string ended_by_;                           ///< reason why the selection ended; empty if the program ended it
  std::deque<device::ScopeSamples> samples_;       ///< unread samples
  std::atomic<std::size_t> rows_kept_ = 0;         ///< may be read without the mutex
  std::unique_ptr<recording::Recorder> recorder_;  ///< changing it also requires `user_mutex_`
  std::optional<recording::EventFeed> feed_;       ///< with `recorder_`
  std::int64_t newest_period_ = 0;                 ///< of the poses during a recording
  bool stops_ = false;

  std::thread thread_;
};

}  // namespace inkwell::library
