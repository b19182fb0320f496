// The scope: chosen signals of every control period, in frames for the bulk endpoint.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <link/scope_plan.hpp>
#include <link/shared.hpp>
#include <protocol/scope.hpp>

namespace inkwell::link {

/// The interrupt writes samples into frames and keeps the finished ones in a backlog; from there it puts
/// the oldest into a hand-over of two places, from which the main loop sends. What is in the hand-over
/// belongs to the main loop until release(). When no frame is free, the oldest of the backlog is dropped
/// and its samples are counted: the interrupt never waits, and the newest data is kept.
class ScopeRecorder {
 public:
  static constexpr std::uint32_t frame_count = 32;
  /// Two, so that the next frame is at hand in the instant in which one has been sent.
  static constexpr std::uint32_t hand_over_places = 2;

  ScopeRecorder();

  // ---- main loop ----

  /// Records these signals from the next period on; none stops, and finishes the frame that was begun.
  /// A new selection forgets the backlog of the one before.
  void select(const protocol::SignalSelection& selection, std::uint8_t token);

  /// The oldest finished frame, empty if there is none. Stays as it is until release().
  std::span<const std::byte> oldest_frame() const;

  /// Gives back the frame that oldest_frame() showed.
  void release();

  /// Samples dropped since the start because the host did not read.
  std::uint32_t samples_dropped() const { return samples_dropped_.load(); }

  // ---- control interrupt ----

  /// Records one sample. Called once every control period.
  void record(const protocol::SignalValues& signals, std::uint32_t periods);

 private:
  using Frame = std::array<std::byte, protocol::scope_frame_maximum>;

  void change_plan();
  void open_frame(std::uint32_t frame);
  void finish_frame();
  std::uint8_t pop_backlog();
  std::uint8_t drop_oldest();
  void hand_over();
  void write_full(const ScopePlan& plan, const protocol::SignalValues& signals);
  void write_changes(const ScopePlan& plan, const protocol::SignalValues& signals);

  alignas(4) std::array<Frame, frame_count> frames_;

  // Between the two sides.
  std::array<ScopePlan, 2> plans_{};
  Shared<bool> plan_offered_{false};
  std::array<std::uint8_t, hand_over_places> handed_{};  ///< frame numbers
  Shared<std::uint32_t> handed_over_{0};                 ///< written by the interrupt
  Shared<std::uint32_t> released_{0};                    ///< written by the main loop
  Shared<std::uint32_t> samples_dropped_{0};             ///< written by the interrupt

  // The interrupt's own.
  std::array<std::uint8_t, frame_count> free_{};  ///< stack of free frames
  std::uint32_t free_count_ = 0;
  std::array<std::uint8_t, frame_count> backlog_{};  ///< ring of finished frames
  std::uint32_t backlog_first_ = 0;
  std::uint32_t backlog_count_ = 0;
  std::uint32_t reclaimed_ = 0;  ///< frames taken back from the hand-over
  std::uint32_t active_plan_ = 0;
  std::uint32_t writing_ = 0;    ///< frame that is written
  std::byte* cursor_ = nullptr;  ///< next byte of it
  const std::byte* frame_end_ = nullptr;
  std::uint32_t sample_count_ = 0;  ///< in it
  std::uint32_t first_period_ = 0;
  std::uint32_t sequence_ = 0;
  std::array<std::uint32_t, protocol::scope_signals_maximum> previous_{};  ///< bits last written
};

}  // namespace inkwell::link
