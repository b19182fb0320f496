// Packs scope signals into frames for the bulk endpoint.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/record/sample_ring.hpp"
#include "firmware/record/scope_plan.hpp"
#include "protocol/scope.hpp"

namespace inkwell::link {

/// Memory for frames. Only the main loop accesses this memory.
struct ScopeFrames {
  static constexpr std::uint32_t count = 10;
  using Frame = std::array<std::byte, protocol::scope_frame_maximum>;
  alignas(4) std::array<Frame, count> frames;
};

/// The main loop reads the sample ring and packs the selected signals into frames. If all frames are in use, the
/// recorder drops the oldest finished frame and counts the dropped samples. The recorder also counts overwritten
/// samples. The interrupt therefore never waits.
class ScopeRecorder {
 public:
  /// Largest number of samples per pass. With more than one sample per pass, the recorder can catch up after a delay of
  /// the main loop.
  static constexpr std::uint32_t samples_per_pack = 4;

  /// The recorder uses `frames` exclusively.
  ScopeRecorder(const SampleRing& samples, ScopeFrames& frames);

  /// Selects the signals to record from the next period on. An empty selection stops recording and finishes the current
  /// frame. A new selection discards the finished frames of the previous selection.
  void select(const protocol::SignalSelection& selection, std::uint8_t token);

  /// Packs up to `samples_per_pack` samples. Call this function in every pass of the main loop.
  void pack();

  /// Returns the oldest finished frame, or an empty span. The frame does not change until release().
  std::span<const std::byte> oldest_frame();

  /// Frees the frame that oldest_frame() returned.
  void release();

  /// Number of samples dropped since start-up. Samples are dropped if the host does not read or if the main loop is
  /// late.
  std::uint32_t samples_dropped() const { return samples_dropped_; }

 private:
  void skip_overwritten(std::uint32_t recorded);
  void pack_oldest();
  void open_frame(std::uint8_t frame);
  void finish_frame();
  std::uint8_t take_finished();
  std::uint8_t drop_oldest();
  void write_full(const protocol::SignalValues& signals);
  void write_changes(const protocol::SignalValues& signals);

  const SampleRing& samples_;
  std::uint32_t packed_ = 0;
  ScopePlan plan_{};
  std::array<ScopeFrames::Frame, ScopeFrames::count>& frames_;
  std::array<std::uint8_t, ScopeFrames::count> free_{};  ///< stack of free frames
  std::uint32_t free_count_ = 0;
  std::array<std::uint8_t, ScopeFrames::count> finished_{};  ///< ring of finished frames
  std::uint32_t finished_first_ = 0;
  std::uint32_t finished_count_ = 0;
  std::optional<std::uint8_t> shown_;  ///< frame returned by oldest_frame()
  std::uint8_t writing_ = 0;           ///< frame that is being written
  std::byte* cursor_ = nullptr;        ///< next byte of the frame that is being written
  const std::byte* frame_end_ = nullptr;
  std::uint32_t sample_count_ = 0;  ///< samples in the frame that is being written
  std::uint32_t first_period_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint32_t samples_dropped_ = 0;
  /// Last written bits of each signal.
  std::array<std::uint32_t, protocol::scope_signals_maximum> previous_{}, previous_slow_{};
};

}  // namespace inkwell::link
