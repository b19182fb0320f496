// Scope frames: what goes over the vendor bulk interface.
//
// A frame is one bulk transfer: a header and the samples of consecutive control periods, at most
// scope_frame_maximum bytes and scope_frame_samples_maximum samples, ended by a short packet (or an empty one where the
// length is a multiple of 64). Between two transfers the bus stands idle until the device has loaded the next one, so
// they are long: 14 floats leave room for two packets there, 36 samples would leave less than half of one. A gap in
// `sequence` is a lost frame; the next frame's `first_period` then tells how many samples.
//
//   full     every sample holds the value of every selected signal, in the order of the selection
//   changes  every sample is a 32-bit mask, bit i standing for the i-th selected signal, followed by
//            the values that differ from the sample before, in rising order of i. The first sample of a
//            frame has every bit set, so a frame is read without the one before it.
//
// `full` is used while a sample takes at most scope_full_sample_maximum bytes: 14 floats at 20 kHz are
// 1.12 MB/s, which full speed (1.216 MB/s) carries beside the pose. A longer selection goes out as changes.
#pragma once

#include <cstddef>
#include <cstdint>

#include <protocol/reports.hpp>

namespace inkwell::protocol {

enum class ScopeEncoding : std::uint8_t { full = 0, changes = 1 };

inline constexpr std::uint32_t scope_magic = 0x43535749;  // "IWSC" as it lies in memory
inline constexpr std::size_t scope_frame_maximum = 6144;
/// 5.5 ms: what a reader waits for, however few signals there are.
inline constexpr std::uint32_t scope_frame_samples_maximum = 109;
inline constexpr std::size_t scope_full_sample_maximum = 56;

#pragma pack(push, 1)
struct ScopeFrameHeader {
  std::uint32_t magic = scope_magic;
  std::uint32_t sequence;         ///< counts frames since the selection
  std::uint32_t first_period;     ///< control period of the first sample, as PoseReport::time_periods
  std::uint32_t samples_dropped;  ///< since the board started, because the host did not read
  std::uint16_t length;           ///< bytes of the frame, header included
  std::uint16_t sample_count;
  ScopeEncoding encoding;
  std::uint8_t signal_count;
  std::uint8_t selection_token;  ///< token of the select_signals command that this frame answers
  std::uint8_t reserved = 0;
};
#pragma pack(pop)
static_assert(sizeof(ScopeFrameHeader) == 24);

/// Bytes of one sample of the signals when all of them are written, without a mask.
constexpr std::size_t full_sample_size(const SignalSelection& selection) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < selection.count; ++i)
    size += wire_size(info(static_cast<Signal>(selection.signals[i])).wire);
  return size;
}

constexpr ScopeEncoding encoding_for(const SignalSelection& selection) {
  return full_sample_size(selection) <= scope_full_sample_maximum ? ScopeEncoding::full : ScopeEncoding::changes;
}

}  // namespace inkwell::protocol
