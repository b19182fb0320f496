// Plays a recording as if it happened now: a pose for the scene, and samples in blocks for the scope, as a live
// session gives them. It has no clock of its own; whoever shows it says how much time passed.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <device/scope_decoder.hpp>
#include <protocol/reports.hpp>
#include <recording/recording.hpp>

namespace inkwell::recording {

class Replay {
 public:
  static constexpr double speed_minimum = 0.01, speed_maximum = 16;

  /// Throws device::Error if the recording holds no samples. Stands still at its start.
  explicit Replay(Recording recording);

  const Recording& recording() const { return recording_; }
  double duration_s() const { return recording_.duration_s(); }
  double position_s() const { return position_s_; }
  double speed() const { return speed_; }
  bool is_playing() const { return is_playing_; }

  /// At the end it starts over.
  void play();
  void pause() { is_playing_ = false; }
  /// To a time since the first sample, cut to what there is.
  void seek(double position_s);
  /// 1 is as fast as it was; cut to speed_minimum..speed_maximum.
  void set_speed(double speed);

  struct Passed {
    bool starts_anew = false;                  ///< after a seek: what was shown before does not lead here
    std::vector<device::ScopeSamples> blocks;  ///< without gaps within; lost samples are counted before each
  };
  /// Lets wall time pass and gives the samples that came by. After a seek these begin `history_s` before the new
  /// position, so that a scope is filled at once. Stops at the end.
  Passed advance(double passed_s, double history_s);

  /// What the device would have reported at the position. None if no joint angles were recorded. State and
  /// switches are not recorded: `active` stands for a force that is not zero, no switch is shown as pressed.
  std::optional<device::Pose> pose() const;

 private:
  std::optional<std::size_t> column_of(protocol::Signal signal) const;
  std::size_t present_sample() const;  ///< the newest at or before the position

  Recording recording_;
  std::array<std::optional<std::size_t>, protocol::signal_count + protocol::force_law_signals_maximum> columns_;
  double position_s_ = 0;
  double speed_ = 1;
  bool is_playing_ = false;
  bool was_moved_ = true;
  std::size_t next_sample_ = 0;  ///< the first that did not come by yet
};

}  // namespace inkwell::recording
