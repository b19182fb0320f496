#include <link/scope_recorder.hpp>

#include <placement/interrupt.hpp>

#include <cmath>
#include <cstring>

namespace inkwell::link {

namespace {

/// Nearest step, saturated; a value that is not a number becomes the lowest step.
std::int16_t to_steps(float value, float steps_per_unit) {
  const float steps = value * steps_per_unit;
  if (!(std::fabs(steps) <= 32767.0f)) [[unlikely]]
    return steps > 0.0f ? std::int16_t{32767} : std::int16_t{-32768};
  // Made positive first, so that the conversion's cut towards zero rounds to the nearest.
  return static_cast<std::int16_t>(static_cast<std::int32_t>(steps + 32768.5f) - 32768);
}

/// What `previous_` holds before the first sample of a frame, so that every signal differs from it: a
/// signalling NaN, which no arithmetic makes, and no 16-bit number with its sign extended.
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

}  // namespace

ScopeRecorder::ScopeRecorder() {
  for (std::uint32_t i = 1; i < frame_count; ++i) free_[free_count_++] = static_cast<std::uint8_t>(i);
  open_frame(0);
}

void ScopeRecorder::select(const protocol::SignalSelection& selection, std::uint8_t token) {
  plan_offered_.store(false);  // from here on the interrupt does not swap, so the spare plan is ours
  plans_[active_plan_ ^ 1u] = prepare(selection, token);
  plan_offered_.store(true);
}

std::span<const std::byte> ScopeRecorder::oldest_frame() const {
  const std::uint32_t released = released_.load();
  if (handed_over_.load() == released) return {};
  const Frame& frame = frames_[handed_[released % hand_over_places]];
  protocol::ScopeFrameHeader header;
  std::memcpy(&header, frame.data(), sizeof header);
  return {frame.data(), header.length};
}

void ScopeRecorder::release() { released_.store(released_.load() + 1); }

INKWELL_INTERRUPT void ScopeRecorder::record(const protocol::SignalValues& signals, std::uint32_t periods) {
  if (plan_offered_.load()) change_plan();
  const ScopePlan& plan = plans_[active_plan_];
  if (plan.count != 0) {
    if (sample_count_ == 0) first_period_ = periods;
    if (plan.encoding == protocol::ScopeEncoding::full)
      write_full(plan, signals);
    else
      write_changes(plan, signals);
    ++sample_count_;
    if (cursor_ + plan.sample_size_maximum > frame_end_) finish_frame();
  }
  hand_over();
}

// Both go through the plan run by run, so that the loop over floats, where most of the time of recording
// goes, has nothing to decide but what it writes.

INKWELL_INTERRUPT void ScopeRecorder::write_full(const ScopePlan& plan, const protocol::SignalValues& signals) {
  std::byte* cursor = cursor_;
  const std::uint8_t* const items = plan.items.data();
  const std::uint8_t* const end = items + plan.count;
  const std::uint8_t* run = plan.run_ends.data();
  for (const std::uint8_t* item = items; item != end;) {
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item)
      append(cursor, bits_of(signals.values[*item]));
    for (const std::uint8_t* const run_end = items + *run++; item < run_end; ++item)
      append(cursor, to_steps(signals.values[*item], plan.steps_per_unit[static_cast<std::size_t>(item - items)]));
  }
  cursor_ = cursor;
}

INKWELL_INTERRUPT void ScopeRecorder::write_changes(const ScopePlan& plan, const protocol::SignalValues& signals) {
  std::byte* const mask_place = cursor_;
  std::byte* cursor = mask_place + sizeof(std::uint32_t);
  if (sample_count_ == 0) previous_.fill(bits_of_no_value);
  std::uint32_t mask = 0;
  std::uint32_t bit = 1;
  std::uint32_t* previous = previous_.data();
  const std::uint8_t* const items = plan.items.data();
  const std::uint8_t* const end = items + plan.count;
  const std::uint8_t* run = plan.run_ends.data();
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
          to_steps(signals.values[*item], plan.steps_per_unit[static_cast<std::size_t>(item - items)]);
      const auto bits = static_cast<std::uint32_t>(steps);
      if (bits == *previous) continue;
      *previous = bits;
      append(cursor, steps);
      mask |= bit;
    }
  }
  std::memcpy(mask_place, &mask, sizeof mask);
  cursor_ = cursor;
}

INKWELL_INTERRUPT void ScopeRecorder::change_plan() {
  if (sample_count_ != 0) finish_frame();
  active_plan_ ^= 1u;
  plan_offered_.store(false);
  if (plans_[active_plan_].count == 0) return;
  // Nobody waits for the samples of the selection before.
  while (backlog_count_ != 0) free_[free_count_++] = pop_backlog();
  sequence_ = 0;
}

INKWELL_INTERRUPT void ScopeRecorder::open_frame(std::uint32_t frame) {
  writing_ = frame;
  cursor_ = frames_[frame].data() + sizeof(protocol::ScopeFrameHeader);
  frame_end_ = frames_[frame].data() + sizeof(Frame);
  sample_count_ = 0;
}

INKWELL_INTERRUPT std::uint8_t ScopeRecorder::pop_backlog() {
  const std::uint8_t frame = backlog_[backlog_first_ % frame_count];
  ++backlog_first_;
  --backlog_count_;
  return frame;
}

INKWELL_INTERRUPT void ScopeRecorder::finish_frame() {
  const ScopePlan& plan = plans_[active_plan_];
  std::byte* const start = frames_[writing_].data();
  protocol::ScopeFrameHeader header;
  header.sequence = sequence_++;
  header.first_period = first_period_;
  header.samples_dropped = samples_dropped_.load();
  header.length = static_cast<std::uint16_t>(cursor_ - start);
  header.sample_count = static_cast<std::uint16_t>(sample_count_);
  header.encoding = plan.encoding;
  header.signal_count = static_cast<std::uint8_t>(plan.count);
  header.selection_token = plan.token;
  std::memcpy(start, &header, sizeof header);

  backlog_[(backlog_first_ + backlog_count_) % frame_count] = static_cast<std::uint8_t>(writing_);
  ++backlog_count_;
  open_frame(free_count_ != 0 ? free_[--free_count_] : drop_oldest());
}

INKWELL_INTERRUPT std::uint8_t ScopeRecorder::drop_oldest() {
  // The backlog can not be empty here: only one frame is written and at most two are handed over.
  const std::uint8_t frame = pop_backlog();
  protocol::ScopeFrameHeader header;
  std::memcpy(&header, frames_[frame].data(), sizeof header);
  samples_dropped_.store(samples_dropped_.load() + header.sample_count);
  return frame;
}

INKWELL_INTERRUPT void ScopeRecorder::hand_over() {
  // One frame each way a period is far more than the bus can carry.
  if (reclaimed_ != released_.load()) {
    free_[free_count_++] = handed_[reclaimed_ % hand_over_places];
    ++reclaimed_;
  }
  const std::uint32_t handed_over = handed_over_.load();
  if (backlog_count_ != 0 && handed_over - reclaimed_ < hand_over_places) {
    handed_[handed_over % hand_over_places] = pop_backlog();
    handed_over_.store(handed_over + 1);
  }
}

}  // namespace inkwell::link
