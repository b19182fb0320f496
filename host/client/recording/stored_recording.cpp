#include "host/client/recording/stored_recording.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::recording {
namespace {

/// Values in memory.
class LoadedColumns final : public ColumnReader {
 public:
  LoadedColumns(std::vector<std::vector<float>> signals, std::vector<std::vector<float>> simulated)
      : columns_(std::move(signals)) {
    std::ranges::move(simulated, std::back_inserter(columns_));
  }
  void read(std::size_t column, std::size_t begin, std::span<float> values) override {
    std::copy_n(columns_[column].begin() + static_cast<std::ptrdiff_t>(begin), values.size(), values.begin());
  }

 private:
  std::vector<std::vector<float>> columns_;
};

}  // namespace

StoredRecording::StoredRecording(Recording recording)
    : stretches_(recording.periods),
      reader_(std::make_shared<LoadedColumns>(std::move(recording.columns), std::move(recording.simulated_columns))) {
  name = std::move(recording.name);
  information = std::move(recording.information);
  complete = recording.complete;
  marks = std::move(recording.marks);
  clock = std::move(recording.clock);
  remarks = std::move(recording.remarks);
}

StoredRecording::StoredRecording(Recording head, Stretches stretches, std::shared_ptr<ColumnReader> reader)
    : name(std::move(head.name)),
      information(std::move(head.information)),
      complete(head.complete),
      marks(std::move(head.marks)),
      clock(std::move(head.clock)),
      remarks(std::move(head.remarks)),
      stretches_(std::move(stretches)),
      reader_(std::move(reader)) {}

std::size_t StoredRecording::sample_at(double elapsed_s) const {
  if (size() == 0 || !(elapsed_s > 0)) return 0;
  // The tolerance of 1 % of a period covers rounding errors, so that a time computed from a sample finds this sample.
  const double periods = std::ceil(elapsed_s * protocol::servo_rate_Hz - 0.01);
  const std::int64_t last = stretches_.last_period() - first_period();
  if (periods > static_cast<double>(last)) return size();
  return stretches_.sample_at(first_period() + static_cast<std::int64_t>(periods));
}

std::size_t StoredRecording::end_of_stretch(std::size_t begin, std::size_t end) const {
  return std::min(end, stretches_.end_of_stretch(begin));
}

std::vector<Quantity> StoredRecording::quantities() const {
  std::vector<Quantity> all(information.signals.begin(), information.signals.end());
  all.insert(all.end(), information.simulated.begin(), information.simulated.end());
  return all;
}

std::size_t StoredRecording::column_of(Quantity quantity) const {
  const auto recorded = quantities();
  const auto found = std::find(recorded.begin(), recorded.end(), quantity);
  if (found != recorded.end()) return static_cast<std::size_t>(found - recorded.begin());
  std::vector<std::string_view> names;
  for (const auto each : recorded) names.push_back(name_of(each));
  throw device::Error(
      fmt::format("The recording does not contain {}. It contains {}.", name_of(quantity), fmt::join(names, ", ")));
}

void StoredRecording::read(std::size_t column, std::size_t begin, std::span<float> values) const {
  if (!values.empty()) reader_->read(column, begin, values);
}

float StoredRecording::value(std::size_t column, std::size_t sample) const {
  float value = 0;
  read(column, sample, {&value, 1});
  return value;
}

std::vector<float> StoredRecording::rows(std::size_t begin, std::size_t end) const {
  const std::size_t width = information.signals.size(), count = end - begin;
  std::vector<float> rows(count * width), column(count);
  for (std::size_t j = 0; j < width; ++j) {
    read(j, begin, column);
    for (std::size_t i = 0; i < count; ++i) rows[i * width + j] = column[i];
  }
  return rows;
}

device::ScopeSamples StoredRecording::samples(std::size_t begin, std::size_t end) const {
  device::ScopeSamples samples{
      .signals = information.signals, .first_period = period(begin), .count = end - begin, .values = rows(begin, end)};
  if (begin > 0) samples.lost_before = static_cast<std::uint64_t>(period(begin) - period(begin - 1) - 1);
  return samples;
}

device::ScopeSamples StoredRecording::held_sample(std::size_t sample) const {
  device::ScopeSamples held = samples(sample, sample + 1);
  if (sample + 1 < size())
    held.count =
        static_cast<std::size_t>(std::min<std::int64_t>(information.step_periods, period(sample + 1) - period(sample)));
  if (sample > 0) held.lost_before -= std::min<std::uint64_t>(held.lost_before, information.step_periods - 1);
  const std::vector<float> values = held.values;
  for (std::size_t i = 1; i < held.count; ++i) held.values.insert(held.values.end(), values.begin(), values.end());
  return held;
}

Recording StoredRecording::load(const std::vector<Quantity>& quantities) const {
  Recording loaded;
  loaded.name = name;
  loaded.information = information;
  loaded.information.signals.clear();
  loaded.information.simulated.clear();
  loaded.complete = complete;
  loaded.marks = marks;
  loaded.clock = clock;
  loaded.remarks = remarks;
  loaded.periods.reserve(size());
  for (std::size_t begin = 0; begin < size();) {
    const std::size_t end = end_of_stretch(begin, size());
    for (std::int64_t at = period(begin); loaded.periods.size() < end; ++at) loaded.periods.push_back(at);
    begin = end;
  }
  for (const auto quantity : quantities) {
    std::vector<float> values(size());
    read(column_of(quantity), 0, values);
    if (const auto* signal = std::get_if<protocol::Signal>(&quantity)) {
      loaded.information.signals.push_back(*signal);
      loaded.columns.push_back(std::move(values));
    } else {
      loaded.information.simulated.push_back(std::get<protocol::SimulatedQuantity>(quantity));
      loaded.simulated_columns.push_back(std::move(values));
    }
  }
  return loaded;
}

std::string log_text(const StoredRecording& recording) {
  std::string text;
  for (const Mark& mark : recording.marks)
    text += device::log_line(mark.clock_utc,
                             recording.size() == 0 ? std::nullopt : std::optional(recording.elapsed_s_at(mark.period)),
                             mark.kind, mark.text);
  return text;
}

}  // namespace inkwell::recording
