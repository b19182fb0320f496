#include "host/client/device/scope_decoder.hpp"

#include <cstring>
#include <utility>

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

/// Returns false if a mask contains unselected signals, or if the first mask does not contain all selected signals.
bool read_changes(Reader& reader, ScopeSamples& samples) {
  const std::size_t signal_count = samples.signals.size();
  const std::uint32_t every_signal = static_cast<std::uint32_t>((std::uint64_t{1} << signal_count) - 1);
  std::vector<float> sample(signal_count);
  for (std::size_t i = 0; i < samples.count && reader.ok(); ++i) {
    const auto mask = reader.take<std::uint32_t>();
    if ((mask & ~every_signal) != 0 || (i == 0 && mask != every_signal)) return false;
    for (std::size_t j = 0; j < signal_count; ++j)
      if (mask >> j & 1u) sample[j] = reader.take_signal(info(samples.signals[j]).wire);
    samples.values.insert(samples.values.end(), sample.begin(), sample.end());
  }
  return true;
}

}  // namespace

void ScopeDecoder::expect(std::uint8_t token, std::vector<protocol::Signal> signals) {
  token_ = token;
  if (signals_.empty()) may_begin_with_rest_ = true;
  signals_ = std::move(signals);
  selection_ = {};
  selection_.count = static_cast<std::uint8_t>(signals_.size());
  for (std::size_t i = 0; i < signals_.size(); ++i) selection_.signals[i] = static_cast<std::uint8_t>(signals_[i]);
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
  else if (!read_changes(reader, samples))
    return refuse();
  if (!reader.ok() || !reader.at_end()) return refuse();

  next_period_ = header.first_period + header.sample_count;
  pass_time(header.first_period);
  return samples;
}

}  // namespace inkwell::device
