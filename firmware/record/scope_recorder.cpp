#include "firmware/record/scope_recorder.hpp"

#include <cmath>
#include <cstring>

namespace inkwell::link {

namespace {

/// Rounds to the nearest step and saturates. NaN becomes the lowest step.
std::int16_t to_steps(float value, float steps_per_unit) {
  const float steps = value * steps_per_unit;
  if (!(std::fabs(steps) <= 32767.0f)) [[unlikely]]
    return steps > 0.0f ? std::int16_t{32767} : std::int16_t{-32768};
  // The offset makes the value positive, so that truncation toward zero rounds to the nearest step.
  return static_cast<std::int16_t>(static_cast<std::int32_t>(steps + 32768.5f) - 32768);
}

/// Initial value of `previous_` in each frame. This value differs from every signal. No computation returns a signaling
/// NaN. The value is not a sign-extended 16-bit integer.
constexpr std::uint32_t bits_of_no_value = 0x7F80'0001;

template <class Value>
[[gnu::always_inline]] inline void append(std::byte*& cursor, Value value) {
  std::memcpy(cursor, &value, sizeof value);
  cursor += sizeof value;
}

[[gnu::always_inline]] inline std::uint32_t bits_of(const float& value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Writes a mask and the changed values. Returns the end of the written bytes.
std::byte* write_changes_of(const ScopeGroup& group, const protocol::SignalValues& signals, std::uint32_t* previous,
                            std::byte* const mask_position) {
  std::byte* cursor = mask_position + sizeof(std::uint32_t);
  std::uint32_t mask = 0;
  std::uint32_t bit = 1;
  const std::uint8_t* const items = group.items.data();
  const std::uint8_t* const end = items + group.count;
  const std::uint8_t* run = group.run_ends.data();
  for (const std::uint8_t* item = items; item != end;) {
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item, ++previous, bit <<= 1) {
      const std::uint32_t bits = bits_of(signals.values[*item]);
      if (bits == *previous) continue;
      *previous = bits;
      append(cursor, bits);
      mask |= bit;
    }
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item, ++previous, bit <<= 1) {
      const std::int16_t steps =
          to_steps(signals.values[*item], group.steps_per_unit[static_cast<std::size_t>(item - items)]);
      const auto bits = static_cast<std::uint32_t>(steps);
      if (bits == *previous) continue;
      *previous = bits;
      append(cursor, steps);
      mask |= bit;
    }
  }
  std::memcpy(mask_position, &mask, sizeof mask);
  return cursor;
}

}  // namespace

ScopeRecorder::ScopeRecorder(const SampleRing& samples, ScopeFrames& frames)
    : samples_(samples), frames_(frames.frames) {
  for (std::uint8_t i = 1; i < ScopeFrames::count; ++i) free_[free_count_++] = i;
  open_frame(0);
}

void ScopeRecorder::select(const protocol::SignalSelection& selection, std::uint8_t token) {
  while (packed_ != samples_.recorded()) pack();
  if (sample_count_ != 0) finish_frame();
  plan_ = prepare(selection, token);
  if (plan_.fast.count == 0) return;
  // The host does not expect samples of the previous selection.
  while (finished_count_ != 0) free_[free_count_++] = take_finished();
  sequence_ = 0;
}

void ScopeRecorder::pack() {
  for (std::uint32_t i = 0; i < samples_per_pack; ++i) {
    const std::uint32_t recorded = samples_.recorded();
    if (plan_.fast.count == 0) packed_ = recorded;
    if (packed_ == recorded) return;
    if (recorded - packed_ > SampleRing::readable) skip_overwritten(recorded);
    pack_oldest();
  }
}

std::span<const std::byte> ScopeRecorder::oldest_frame() {
  if (!shown_) {
    if (finished_count_ == 0) return {};
    shown_ = take_finished();
  }
  const ScopeFrames::Frame& frame = frames_[*shown_];
  protocol::ScopeFrameHeader header;
  std::memcpy(&header, frame.data(), sizeof header);
  return {frame.data(), header.length};
}

void ScopeRecorder::release() {
  if (shown_) free_[free_count_++] = *shown_;
  shown_.reset();
}

/// The periods of a frame are consecutive. If samples are skipped, the current frame is therefore finished.
void ScopeRecorder::skip_overwritten(std::uint32_t recorded) {
  if (sample_count_ != 0) finish_frame();
  samples_dropped_ += recorded - SampleRing::readable - packed_;
  packed_ = recorded - SampleRing::readable;
}

void ScopeRecorder::pack_oldest() {
  const Sample& sample = samples_[packed_];
  if (sample_count_ == 0) first_period_ = sample.summary.periods;
  if (plan_.encoding == protocol::ScopeEncoding::full)
    write_full(sample.signals);
  else
    write_changes(sample.signals);
  ++packed_;
  ++sample_count_;
  if (sample_count_ == protocol::scope_frame_samples_maximum || cursor_ + plan_.sample_size_maximum > frame_end_)
    finish_frame();
}

// The write functions process a group of signals run by run. The loop over floats needs most of the recording time. The
// loop over floats therefore has no branch for the encoding.

void ScopeRecorder::write_full(const protocol::SignalValues& signals) {
  std::byte* cursor = cursor_;
  const ScopeGroup& group = plan_.fast;
  const std::uint8_t* const items = group.items.data();
  const std::uint8_t* const end = items + group.count;
  const std::uint8_t* run = group.run_ends.data();
  for (const std::uint8_t* item = items; item != end;) {
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item)
      append(cursor, bits_of(signals.values[*item]));
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item)
      append(cursor, to_steps(signals.values[*item], group.steps_per_unit[static_cast<std::size_t>(item - items)]));
  }
  cursor_ = cursor;
}

void ScopeRecorder::write_changes(const protocol::SignalValues& signals) {
  if (sample_count_ == 0) {
    previous_.fill(bits_of_no_value);
    previous_slow_.fill(bits_of_no_value);
  }
  cursor_ = write_changes_of(plan_.fast, signals, previous_.data(), cursor_);
  if (plan_.slow.count != 0 && sample_count_ % protocol::scope_slow_interval == 0)
    cursor_ = write_changes_of(plan_.slow, signals, previous_slow_.data(), cursor_);
}

void ScopeRecorder::open_frame(std::uint8_t frame) {
  writing_ = frame;
  cursor_ = frames_[frame].data() + sizeof(protocol::ScopeFrameHeader);
  frame_end_ = frames_[frame].data() + frames_[frame].size();
  sample_count_ = 0;
}

void ScopeRecorder::finish_frame() {
  std::byte* const start = frames_[writing_].data();
  protocol::ScopeFrameHeader header;
  header.sequence = sequence_++;
  header.first_period = first_period_;
  header.samples_dropped = samples_dropped_;
  header.length = static_cast<std::uint16_t>(cursor_ - start);
  header.sample_count = static_cast<std::uint16_t>(sample_count_);
  header.encoding = plan_.encoding;
  header.signal_count = static_cast<std::uint8_t>(plan_.fast.count + plan_.slow.count);
  header.selection_token = plan_.token;
  std::memcpy(start, &header, sizeof header);

  finished_[(finished_first_ + finished_count_) % ScopeFrames::count] = writing_;
  ++finished_count_;
  open_frame(free_count_ != 0 ? free_[--free_count_] : drop_oldest());
}

std::uint8_t ScopeRecorder::take_finished() {
  const std::uint8_t frame = finished_[finished_first_ % ScopeFrames::count];
  ++finished_first_;
  --finished_count_;
  return frame;
}

std::uint8_t ScopeRecorder::drop_oldest() {
  // A finished frame exists, because only one frame is being written and at most one frame is being sent.
  const std::uint8_t frame = take_finished();
  protocol::ScopeFrameHeader header;
  std::memcpy(&header, frames_[frame].data(), sizeof header);
  samples_dropped_ += header.sample_count;
  return frame;
}

}  // namespace inkwell::link
