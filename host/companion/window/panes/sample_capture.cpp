#include "host/companion/window/panes/sample_capture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/client/recording/writer.hpp"
#include "protocol/reports.hpp"

namespace inkwell::window {

namespace {

constexpr std::size_t samples_per_block = protocol::servo_rate_Hz / 10;

std::int64_t end_of(const device::ScopeSamples& samples) {
  return samples.first_period + static_cast<std::int64_t>(samples.count);
}

}  // namespace

void SampleCapture::clear() {
  blocks_.clear();
  open_.reset();
}

std::int64_t SampleCapture::end_period() const { return open_ ? end_of(*open_) : end_of(*blocks_.back()); }

double SampleCapture::duration_s() const {
  if (is_empty()) return 0.0;
  const std::int64_t first = blocks_.empty() ? open_->first_period : blocks_.front()->first_period;
  return device::board_time_s(end_period() - first);
}

void SampleCapture::close_block() {
  if (open_) blocks_.push_back(std::make_shared<const device::ScopeSamples>(std::move(*open_)));
  open_.reset();
}

void SampleCapture::add(const device::ScopeSamples& samples) {
  if (samples.count == 0) return;
  if (!is_empty() && samples.first_period < end_period()) clear();
  const bool continues = open_ && open_->signals == samples.signals && samples.first_period == end_of(*open_) &&
                         open_->count < samples_per_block;
  if (!continues) {
    close_block();
    open_ = device::ScopeSamples{samples.signals, samples.first_period, 0, {}, 0};
    open_->values.reserve(samples_per_block * samples.signals.size());
  }
  open_->count += samples.count;
  open_->values.insert(open_->values.end(), samples.values.begin(), samples.values.end());
  const auto kept_periods = static_cast<std::int64_t>(kept_s * protocol::servo_rate_Hz);
  while (!blocks_.empty() && end_of(*blocks_.front()) < end_period() - kept_periods) blocks_.pop_front();
}

std::vector<SampleCapture::Block> SampleCapture::blocks() const {
  std::vector<Block> all(blocks_.begin(), blocks_.end());
  if (open_) all.push_back(std::make_shared<const device::ScopeSamples>(*open_));
  return all;
}

device::ScopeSamples converted(const device::ScopeSamples& samples, const std::vector<protocol::Signal>& signals) {
  if (samples.signals == signals) return samples;
  device::ScopeSamples result{signals, samples.first_period, samples.count, {}, samples.lost_before};
  result.values.assign(samples.count * signals.size(), std::numeric_limits<float>::quiet_NaN());
  const std::size_t width = samples.signals.size();
  for (std::size_t column = 0; column < signals.size(); ++column) {
    const auto found = std::ranges::find(samples.signals, signals[column]);
    if (found == samples.signals.end()) continue;
    const auto from = static_cast<std::size_t>(found - samples.signals.begin());
    for (std::size_t i = 0; i < samples.count; ++i)
      result.values[i * signals.size() + column] = samples.values[i * width + from];
  }
  return result;
}

std::string write_captured(const CapturedRecording& captured) {
  try {
    const auto writer = recording::create(captured.file, captured.information);
    auto mark = captured.marks.begin();
    for (const SampleCapture::Block& block : captured.blocks) {
      writer->append(converted(*block, captured.information.signals), {});
      for (; mark != captured.marks.end() && mark->period < end_of(*block); ++mark) writer->mark(*mark);
    }
    writer->finish();
    return {};
  } catch (const device::Error& error) {
    return error.what();
  }
}

}  // namespace inkwell::window
