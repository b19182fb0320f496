#include "host/client/device/scope_decoder.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::device {
namespace {

/// Also returns the correct result when the period counter wraps.
bool is_before(std::uint32_t period, std::uint32_t other) { return period - other > 0x8000'0000u; }

using protocol::SignalWire;

/// Reads consecutive values. Sets `ok_` to false at the end of the data.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class Value>
  Value take() {
    Value value{};
    if (bytes_.size() < sizeof(Value)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof(Value));
    bytes_ = bytes_.subspan(sizeof(Value));
    return value;
  }

  float take_signal(SignalWire wire) {
    switch (wire) {
      case SignalWire::float32: return take<float>();
      case SignalWire::current_int16: return static_cast<float>(take<std::int16_t>()) * protocol::current_step_A;
      case SignalWire::duty_int16: return static_cast<float>(take<std::int16_t>()) * protocol::duty_step;
    }
    ok_ = false;
    return 0;
  }

  bool ok() const { return ok_; }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  bool ok_ = true;
};

void read_full(Reader& reader, ScopeSamples& samples) {
  for (std::size_t i = 0; i < samples.count && reader.ok(); ++i)
    for (auto signal : samples.signals) samples.values.push_back(reader.take_signal(info(signal).wire));
}

/// Reads a mask and the changed values of the signals in these columns. Returns false if the mask contains unselected
/// signals, or if the first mask does not contain all selected signals.
bool read_changes_of(Reader& reader, std::span<const std::size_t> columns, bool is_first,
                     std::span<const protocol::Signal> signals, std::vector<float>& sample) {
  const std::uint32_t every_signal = static_cast<std::uint32_t>((std::uint64_t{1} << columns.size()) - 1);
  const auto mask = reader.take<std::uint32_t>();
  if ((mask & ~every_signal) != 0 || (is_first && mask != every_signal)) return false;
  for (std::size_t j = 0; j < columns.size(); ++j)
    if (mask >> j & 1u) sample[columns[j]] = reader.take_signal(info(signals[columns[j]]).wire);
  return true;
}

/// Returns false if a mask is wrong.
bool read_changes(Reader& reader, std::span<const std::size_t> columns, ScopeSamples& samples) {
  const auto fast = columns.first(std::min(columns.size(), protocol::scope_signals_maximum));
  const auto slow = columns.subspan(fast.size());
  std::vector<float> sample(columns.size());
  for (std::size_t i = 0; i < samples.count && reader.ok(); ++i) {
    if (!read_changes_of(reader, fast, i == 0, samples.signals, sample)) return false;
    const bool has_slow = !slow.empty() && i % protocol::scope_slow_interval == 0;
    if (has_slow && !read_changes_of(reader, slow, i == 0, samples.signals, sample)) return false;
    samples.values.insert(samples.values.end(), sample.begin(), sample.end());
  }
  return true;
}

}  // namespace

void check_selection(std::span<const protocol::Signal> signals) {
  if (signals.size() <= protocol::scope_signals_maximum) return;
  std::vector<protocol::Signal> sorted(signals.begin(), signals.end());
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end())
    throw Error(fmt::format(
        "The scope cannot transmit {} signals that contain a signal twice. Give each signal once, or at most "
        "{} signals.",
        signals.size(), protocol::scope_signals_maximum));
}

protocol::SignalSelection selection_of(std::span<const protocol::Signal> signals) {
  protocol::SignalSelection selection{};
  const bool has_mask = signals.size() > protocol::scope_signals_maximum;
  selection.count = has_mask ? protocol::selected_by_mask : static_cast<std::uint8_t>(signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const auto id = static_cast<std::uint8_t>(signals[i]);
    if (has_mask)
      selection.signals[id / 8] = static_cast<std::uint8_t>(selection.signals[id / 8] | 1u << id % 8);
    else
      selection.signals[i] = id;
  }
  return selection;
}

void ScopeDecoder::expect(std::uint8_t token, std::vector<protocol::Signal> signals) {
  token_ = token;
  if (signals_.empty()) may_begin_with_rest_ = true;
  signals_ = std::move(signals);
  selection_ = selection_of(signals_);
  columns_.resize(signals_.size());
  std::iota(columns_.begin(), columns_.end(), std::size_t{0});
  // A bit mask selects the signals in the order of the table.
  if (selection_.count == protocol::selected_by_mask)
    std::ranges::sort(columns_, {}, [&](std::size_t column) { return signals_[column]; });
  next_period_.reset();
}

std::optional<ScopeSamples> ScopeDecoder::refuse() {
  ++malformed_frames_;
  return std::nullopt;
}

std::optional<ScopeSamples> ScopeDecoder::refuse_all_but_a_rest() {
  if (!std::exchange(may_begin_with_rest_, false)) return refuse();
  return std::nullopt;
}

std::uint64_t ScopeDecoder::lost_before(const protocol::ScopeFrameHeader& header) const {
  if (!next_period_) return header.sequence;
  return header.first_period - *next_period_;  // valid when the unsigned period counter wraps
}

std::optional<ScopeSamples> ScopeDecoder::decode(std::span<const std::byte> scope_frame) {
  protocol::ScopeFrameHeader header;
  if (scope_frame.size() > protocol::scope_frame_maximum) return refuse();
  if (scope_frame.size() < sizeof header) return refuse_all_but_a_rest();
  std::memcpy(&header, scope_frame.data(), sizeof header);
  if (header.magic != protocol::scope_magic) return refuse_all_but_a_rest();
  if (header.length != scope_frame.size()) return refuse();
  if (token_ != header.selection_token) return std::nullopt;
  if (first_wanted_period_ && is_before(header.first_period, *first_wanted_period_)) return std::nullopt;
  may_begin_with_rest_ = false;
  if (header.signal_count != signals_.size() || header.encoding != encoding_for(selection_) ||
      header.sample_count == 0 || signals_.empty())
    return refuse();

  // A decreasing period means that this frame or the previous frame is wrong. The decoder refuses this frame and
  // compares the next frame with it.
  const bool runs_backwards = next_period_ && is_before(header.first_period, *next_period_);
  if (runs_backwards) {
    next_period_ = header.first_period + header.sample_count;
    return refuse();
  }

  ScopeSamples samples{signals_, header.first_period, header.sample_count, {}, lost_before(header)};
  samples.values.reserve(samples.count * signals_.size());
  Reader reader(scope_frame.subspan(sizeof header));
  if (header.encoding == protocol::ScopeEncoding::full)
    read_full(reader, samples);
  else if (!read_changes(reader, columns_, samples))
    return refuse();
  if (!reader.ok() || !reader.at_end()) return refuse();

  next_period_ = header.first_period + header.sample_count;
  pass_time(header.first_period);
  return samples;
}

}  // namespace inkwell::device
