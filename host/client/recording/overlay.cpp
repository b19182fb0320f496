#include "host/client/recording/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace inkwell::recording {
namespace {

std::int64_t periods_to_mark(const StoredRecording& recording, std::string_view text) {
  const auto found = std::ranges::find(recording.marks, text, &Mark::text);
  if (found != recording.marks.end()) return found->period - recording.first_period();
  std::vector<std::string> texts;
  for (const Mark& mark : recording.marks) texts.push_back("`" + mark.text + "`");
  throw device::Error(fmt::format("{} has no mark `{}`. It has {}.", recording.name, text,
                                  texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", "))));
}

void check_holds_samples(const StoredRecording& recording) {
  if (recording.size() == 0)
    throw device::Error(fmt::format("{} contains no samples, so it cannot be compared.", recording.name));
}

}  // namespace

Overlay::Overlay(StoredRecording over, const StoredRecording& base, std::string_view mark) : over_(std::move(over)) {
  signals_ = over_.information.signals;
  check_holds_samples(over_);
  check_holds_samples(base);
  base_begins_periods_ = base.first_period();
  if (!mark.empty()) shift_periods_ = periods_to_mark(base, mark) - periods_to_mark(over_, mark);
}

bool Overlay::select(const std::vector<protocol::Signal>& shown) {
  auto selected = recorded_of(over_.information.signals, shown);
  if (selected == signals_) return false;
  signals_ = std::move(selected);
  return true;
}

device::ScopeSamples Overlay::compared_with(const device::ScopeSamples& of_base) const {
  device::ScopeSamples samples{.signals = signals_,
                               .first_period = of_base.first_period,
                               .count = of_base.count,
                               .values = {},
                               .lost_before = of_base.lost_before};
  const std::size_t width = signals_.size();
  samples.values.assign(samples.count * width, std::nanf(""));
  const std::int64_t first = of_base.first_period - base_begins_periods_ - shift_periods_;
  const auto elapsed_periods = [&](std::size_t sample) { return over_.period(sample) - over_.first_period(); };
  // The search starts with the newest sample at or before the first period. The values of a sample apply until the next
  // sample.
  std::size_t sample = over_.sample_at(static_cast<double>(first) / protocol::servo_rate_Hz);
  if (sample > 0 && (sample == over_.size() || elapsed_periods(sample) > first)) --sample;
  const double end_s = static_cast<double>(first + static_cast<std::int64_t>(samples.count)) / protocol::servo_rate_Hz;
  const std::size_t begin = std::min(sample, over_.size() - 1), end = std::max(begin, over_.sample_at(end_s));
  const std::vector<float> rows = over_.rows(begin, end, signals_);
  for (std::size_t i = 0; i < samples.count && begin < end; ++i) {
    const std::int64_t at = first + static_cast<std::int64_t>(i);
    while (sample + 1 < end && elapsed_periods(sample + 1) <= at) ++sample;
    const std::int64_t age = at - elapsed_periods(sample);
    if (age < 0 || age >= std::int64_t{over_.information.step_periods}) continue;
    for (std::size_t j = 0; j < width; ++j) samples.values[i * width + j] = rows[(sample - begin) * width + j];
  }
  return samples;
}

std::pair<std::string, std::string> distinct_names(const std::filesystem::path& one,
                                                   const std::filesystem::path& other) {
  const auto canonical = [](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  };
  std::filesystem::path one_folder = canonical(one).replace_extension(),
                        other_folder = canonical(other).replace_extension(), one_name, other_name;
  if (one_folder == other_folder && one.extension() != other.extension())
    return {one.filename().string(), other.filename().string()};
  do {
    one_name = one_folder.filename() / one_name;
    other_name = other_folder.filename() / other_name;
    one_folder = one_folder.parent_path();
    other_folder = other_folder.parent_path();
  } while (one_name == other_name && one_folder != other_folder);
  return {one_name.parent_path().string(), other_name.parent_path().string()};  // without the trailing "/"
}

std::vector<std::string> common_marks(const StoredRecording& a, const StoredRecording& b) {
  std::vector<std::string> common;
  for (const Mark& mark : a.marks)
    if (std::ranges::find(b.marks, mark.text, &Mark::text) != b.marks.end() &&
        std::ranges::find(common, mark.text) == common.end())
      common.push_back(mark.text);
  return common;
}

}  // namespace inkwell::recording
