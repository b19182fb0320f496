#include "host/client/recording/stored_recording.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::recording {
namespace {

constexpr std::size_t piece_samples = 4096;         // as in a chunk of a file
constexpr std::size_t overview_blocks_minimum = 4;  // in a range, so that a widened range is drawn at the same pixel

/// Calls action(begin, end) for each piece of a range. A piece does not cross a chunk of the file.
template <class Action>
void in_pieces(std::size_t begin, std::size_t end, Action action) {
  while (begin < end) {
    const std::size_t next = std::min(end, (begin / piece_samples + 1) * piece_samples);
    action(begin, next);
    begin = next;
  }
}

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

SampleRange StoredRecording::overview_part(SampleRange range) const {
  constexpr std::size_t block = overview_block_samples;
  const SampleRange none{range.end, range.end};
  if (range.begin + overview_blocks_minimum * block > range.end) return none;
  std::size_t begin = range.begin / block * block, end = (range.end + block - 1) / block * block;
  if (has_gap(begin, range.begin + 1)) begin += block;
  if (end > size() || has_gap(range.end - 1, end)) end -= block;
  end = std::min(end, reader_->overview_blocks() * block);
  return begin < end ? SampleRange{begin, end} : none;
}

void StoredRecording::add_samples(std::span<BandSum> sums, std::span<const std::size_t> columns,
                                  SampleRange range) const {
  std::vector<float> values;
  // A CSV file contains all columns of a sample in one line, so all columns of a piece are read before the next piece.
  in_pieces(range.begin, range.end, [&](std::size_t begin, std::size_t end) {
    values.resize(end - begin);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      read(columns[j], begin, values);
      BandSum sum = sums[j];
      for (const float value : values) sum.add(static_cast<double>(value));
      sums[j] = sum;
    }
  });
}

std::vector<std::vector<Band>> StoredRecording::bands(std::span<const std::size_t> columns,
                                                      std::span<const SampleRange> ranges) const {
  std::vector<std::vector<Band>> all;
  all.reserve(ranges.size());
  std::vector<OverviewBlock> blocks;
  for (const SampleRange range : ranges) {
    std::vector<BandSum> sums(columns.size());
    const SampleRange part = overview_part(range);
    add_samples(sums, columns, {range.begin, std::min(part.begin, range.end)});
    if (part.begin < part.end) {
      blocks.resize((part.end - part.begin) / overview_block_samples);
      for (std::size_t j = 0; j < columns.size(); ++j) {
        reader_->read_overview(columns[j], part.begin / overview_block_samples, blocks);
        for (const auto [minimum, maximum, mean] : blocks)
          sums[j].add({static_cast<double>(mean), static_cast<double>(minimum), static_cast<double>(maximum)},
                      overview_block_samples);
      }
      add_samples(sums, columns, {part.end, range.end});
    }
    std::vector<Band>& row = all.emplace_back();
    for (const BandSum& sum : sums) row.push_back(sum.band());
  }
  return all;
}

std::vector<float> StoredRecording::rows(std::size_t begin, std::size_t end,
                                         std::span<const protocol::Signal> signals) const {
  const std::size_t width = signals.size();
  std::vector<std::size_t> columns;
  for (const auto signal : signals) columns.push_back(column_of(signal));
  std::vector<float> rows((end - begin) * width), column;
  in_pieces(begin, end, [&](std::size_t first, std::size_t last) {
    column.resize(last - first);
    for (std::size_t j = 0; j < width; ++j) {
      read(columns[j], first, column);
      for (std::size_t i = 0; i < column.size(); ++i) rows[(first - begin + i) * width + j] = column[i];
    }
  });
  return rows;
}

device::ScopeSamples StoredRecording::samples(std::size_t begin, std::size_t end,
                                              const std::vector<protocol::Signal>& signals) const {
  device::ScopeSamples samples{
      .signals = signals, .first_period = period(begin), .count = end - begin, .values = rows(begin, end, signals)};
  if (begin > 0) samples.lost_before = static_cast<std::uint64_t>(period(begin) - period(begin - 1) - 1);
  return samples;
}

device::ScopeSamples StoredRecording::held_sample(std::size_t sample,
                                                  const std::vector<protocol::Signal>& signals) const {
  device::ScopeSamples held = samples(sample, sample + 1, signals);
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
  std::vector<std::size_t> columns;
  for (const auto quantity : quantities) columns.push_back(column_of(quantity));
  std::vector<std::vector<float>> values(quantities.size(), std::vector<float>(size()));
  in_pieces(0, size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = 0; j < columns.size(); ++j)
      read(columns[j], begin, std::span(values[j]).subspan(begin, end - begin));
  });
  for (std::size_t j = 0; j < quantities.size(); ++j)
    if (const auto* signal = std::get_if<protocol::Signal>(&quantities[j])) {
      loaded.information.signals.push_back(*signal);
      loaded.columns.push_back(std::move(values[j]));
    } else {
      loaded.information.simulated.push_back(std::get<protocol::SimulatedQuantity>(quantities[j]));
      loaded.simulated_columns.push_back(std::move(values[j]));
    }
  return loaded;
}

std::vector<protocol::Signal> recorded_of(const std::vector<protocol::Signal>& recorded,
                                          const std::vector<protocol::Signal>& shown) {
  std::vector<protocol::Signal> both;
  std::ranges::copy_if(recorded, std::back_inserter(both),
                       [&](protocol::Signal each) { return std::ranges::find(shown, each) != shown.end(); });
  return both;
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
