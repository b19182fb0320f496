// Replays a recording like a live session: a pose for the scene, and blocks of samples for the scope. The caller
// supplies the elapsed time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/client/device/scope_decoder.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "protocol/reports.hpp"

namespace inkwell::recording {

class Replay {
 public:
  static constexpr double speed_minimum = 0.01, speed_maximum = 16;

  /// Throws device::Error if the recording has no samples. The replay is initially paused at the start.
  explicit Replay(StoredRecording recording);

  const StoredRecording& recording() const { return recording_; }
  double duration_s() const { return recording_.duration_s(); }
  double position_s() const { return position_s_; }
  double speed() const { return speed_; }
  /// Signals of the returned samples.
  const std::vector<protocol::Signal>& signals() const { return signals_; }
  /// Selects the signals of the returned samples, because reading all signals takes longer. Signals that were not
  /// recorded are omitted. Default: all signals. Returns true if the selection has changed.
  bool select(const std::vector<protocol::Signal>& shown);
  bool is_playing() const { return is_playing_; }

  /// Starts the replay. If the replay has reached the end, it restarts from the beginning.
  void play();
  void pause() { is_playing_ = false; }
  /// Moves to a time since the first sample, limited to the recording.
  void seek(double position_s);
  /// Sets the speed, limited to speed_minimum..speed_maximum; 1 is the recorded speed.
  void set_speed(double speed);

  struct Passed {
    bool is_restart = false;                   ///< after a seek: the samples do not continue the earlier ones
    std::vector<device::ScopeSamples> blocks;  ///< without gaps inside; each block counts the lost samples before it
  };
  /// Advances by wall time and returns the samples of this interval. After a seek, the samples start `history_s` before
  /// the new position, so that a scope is filled immediately. The replay stops at the end.
  Passed advance(double passed_s, double history_s);
  /// Returns the samples of a time range again, for example after select().
  std::vector<device::ScopeSamples> between(std::int64_t first_period, std::int64_t end_period) const;

  /// Pose at the present position. std::nullopt if no joint angles were recorded. State and switches are not recorded.
  /// The returned state is `active` if the force is not zero. In the returned pose no switch is pressed.
  std::optional<device::Pose> pose() const;

 private:
  std::optional<std::size_t> column_of(protocol::Signal signal) const;
  void add_blocks(std::vector<device::ScopeSamples>& blocks, std::size_t begin, std::size_t end) const;
  std::size_t present_sample() const;  ///< the newest sample at or before the position

  StoredRecording recording_;
  std::vector<protocol::Signal> signals_;
  std::array<std::optional<std::size_t>, protocol::signal_count + protocol::force_law_signals_maximum> columns_;
  double position_s_ = 0;
  double speed_ = 1;
  bool is_playing_ = false;
  bool was_moved_ = true;
  std::size_t next_sample_ = 0;  ///< the first sample that was not returned yet
};

}  // namespace inkwell::recording
