// The scope: chosen signals of every control period, in frames for the bulk endpoint.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <link/sample_ring.hpp>
#include <link/scope_plan.hpp>
#include <protocol/scope.hpp>

namespace inkwell::link {

/// Room for frames: large, and touched by the main loop only.
struct ScopeFrames {
  static constexpr std::uint32_t count = 10;
  using Frame = std::array<std::byte, protocol::scope_frame_maximum>;
  alignas(4) std::array<Frame, count> frames;
};

/// The main loop follows the ring of samples, picks the selected signals and packs them into frames. When no frame is
/// free, the oldest that is not being sent is dropped and its samples are counted, and so are samples that the main
/// loop was too late for: the interrupt never waits, and the newest data is kept.
class ScopeRecorder {
 public:
  /// So that the main loop comes round also when it has been late; it comes once a period.
  static constexpr std::uint32_t samples_per_pack = 4;

  /// `frames` are the recorder's from now on.
  ScopeRecorder(const SampleRing& samples, ScopeFrames& frames);

  /// Records these signals from the next period on; none stops, and finishes the frame that was begun.
  /// A new selection forgets the finished frames of the one before.
  void select(const protocol::SignalSelection& selection, std::uint8_t token);

  /// Packs the oldest samples that wait, `samples_per_pack` at most. Call it every time that the main loop comes round.
  void pack();

  /// The oldest finished frame, empty if there is none. Stays as it is until release().
  std::span<const std::byte> oldest_frame();

  /// Gives back the frame that oldest_frame() showed.
  void release();

  /// Samples dropped since the start because the host did not read, or the main loop was late.
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
  std::array<std::uint8_t, ScopeFrames::count> finished_{};  ///< ring
  std::uint32_t finished_first_ = 0;
  std::uint32_t finished_count_ = 0;
  std::optional<std::uint8_t> shown_;  ///< by oldest_frame()
  std::uint8_t writing_ = 0;           ///< frame that is written
  std::byte* cursor_ = nullptr;        ///< next byte of it
  const std::byte* frame_end_ = nullptr;
  std::uint32_t sample_count_ = 0;  ///< in it
  std::uint32_t first_period_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint32_t samples_dropped_ = 0;
  std::array<std::uint32_t, protocol::scope_signals_maximum> previous_{};  ///< bits last written
};

}  // namespace inkwell::link
