// Scope frames, sent over the vendor bulk interface.
//
// A frame is one bulk transfer: a header and the samples of consecutive control periods. A frame has at most
// scope_frame_maximum bytes and scope_frame_samples_maximum samples. The last packet of each transfer has 0 to 63
// bytes.
//
// Between two transfers the bus is idle until the device has loaded the next frame. Long frames reduce the idle time. A
// gap in `sequence` indicates a lost frame. The field `first_period` of the next frame shows the number of lost
// samples.
//
// In the encoding `full`, a sample has the value of every selected signal, in the order of the selection.
//
// In the encoding `changes`, a sample begins with a 32-bit mask, in which bit i stands for the i-th selected signal.
// The values that differ from the previous sample follow in rising order of i. The first sample of a frame has every
// bit set, so that a reader can decode each frame alone.
//
// A selection of more than 32 signals is a bit mask, so its signals are in the order of the table. Its samples contain
// the first 32 signals as above. In every scope_slow_interval-th sample of a frame, beginning with the first sample, a
// second mask and the changed values of the other signals follow.
//
// The encoding is `full` for samples of up to scope_full_sample_maximum bytes. At 20 kHz, 14 floats require 1.12 MB/s.
// Full-speed USB transmits up to 1.216 MB/s in addition to the pose. Longer samples are encoded as `changes`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/reports.hpp"

namespace inkwell::protocol {

enum class ScopeEncoding : std::uint8_t { full = 0, changes = 1 };

inline constexpr std::uint32_t scope_magic = 0x43535749;  // "IWSC" in little-endian byte order
inline constexpr std::size_t scope_frame_maximum = 6144;
/// For a selection of few signals, the latency is at most 109 periods (5.5 ms).
inline constexpr std::uint32_t scope_frame_samples_maximum = 109;
inline constexpr std::size_t scope_full_sample_maximum = 56;
/// The signals after the 32nd are transmitted at 1250 Hz, because the bus cannot transmit all signals at 20 kHz.
inline constexpr std::uint32_t scope_slow_interval = 16;
inline constexpr std::size_t scope_wide_maximum = 2 * scope_signals_maximum;
static_assert(signal_count + force_law_signals_maximum <= scope_wide_maximum);

#pragma pack(push, 1)
struct ScopeFrameHeader {
  std::uint32_t magic = scope_magic;
  std::uint32_t sequence;         ///< number of frames since the selection
  std::uint32_t first_period;     ///< control period of the first sample, as PoseReport::time_periods
  std::uint32_t samples_dropped;  ///< samples lost since start-up because the host did not read
  std::uint16_t length;           ///< bytes of the frame, including the header
  std::uint16_t sample_count;
  ScopeEncoding encoding;
  std::uint8_t signal_count;
  std::uint8_t selection_token;  ///< token of the select_signals command that started this stream
  std::uint8_t reserved = 0;
};
#pragma pack(pop)
static_assert(sizeof(ScopeFrameHeader) == 24);

/// Ids of the selected signals, in the order of the transmission.
struct SelectedSignals {
  std::array<std::uint8_t, scope_wide_maximum> items{};
  std::size_t count = 0;
};

constexpr SelectedSignals selected_signals(const SignalSelection& selection) {
  SelectedSignals selected;
  if (selection.count != selected_by_mask) {
    for (; selected.count < selection.count; ++selected.count)
      selected.items[selected.count] = selection.signals[selected.count];
    return selected;
  }
  for (std::size_t signal = 0; signal < scope_wide_maximum; ++signal)
    if ((selection.signals[signal / 8] >> (signal % 8) & 1) != 0)
      selected.items[selected.count++] = static_cast<std::uint8_t>(signal);
  return selected;
}

/// Returns the size of one sample in the encoding `full`, in bytes.
constexpr std::size_t full_sample_size(const SignalSelection& selection) {
  const SelectedSignals selected = selected_signals(selection);
  std::size_t size = 0;
  for (std::size_t i = 0; i < selected.count; ++i) size += wire_size(info(static_cast<Signal>(selected.items[i])).wire);
  return size;
}

constexpr ScopeEncoding encoding_for(const SignalSelection& selection) {
  return full_sample_size(selection) <= scope_full_sample_maximum ? ScopeEncoding::full : ScopeEncoding::changes;
}

}  // namespace inkwell::protocol
