#include "host/client/recording/recording.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/wide_counter.hpp"
#include "host/client/local/replaced_file.hpp"
#include "host/client/local/text_file.hpp"
#include "protocol/plain_text.hpp"

#include "host/client/recording/formats.hpp"

namespace inkwell::recording {

Recording Recording::without_samples(Information information) {
  Recording recording;
  recording.columns.resize(information.signals.size());
  recording.simulated_columns.resize(information.simulated.size());
  recording.information = std::move(information);
  return recording;
}

std::uint64_t Recording::lost() const {
  if (periods.size() < 2) return 0;
  const std::int64_t step = information.step_periods;
  if (step == 1) {
    const auto passed = static_cast<std::uint64_t>(periods.back() - periods.front()) + 1;
    return passed - std::min<std::uint64_t>(passed, periods.size());
  }
  std::int64_t count = 0;
  for (std::size_t i = 1; i < size(); ++i) count += (periods[i] - periods[i - 1] - 1) / step;
  return static_cast<std::uint64_t>(count);
}

std::size_t Recording::sample_at(double elapsed) const {
  // The tolerance of 1 % of a period covers rounding errors, so that a time computed from a sample finds this sample.
  const double rounding_s = 0.01 / protocol::servo_rate_Hz;
  std::size_t first = 0, end = size();  // search range of the result
  while (first < end) {
    const std::size_t middle = first + (end - first) / 2;
    if (elapsed_s(middle) < elapsed - rounding_s)
      first = middle + 1;
    else
      end = middle;
  }
  return first;
}

std::vector<Quantity> Recording::quantities() const {
  std::vector<Quantity> all(information.signals.begin(), information.signals.end());
  all.insert(all.end(), information.simulated.begin(), information.simulated.end());
  return all;
}

const std::vector<float>& Recording::column(Quantity quantity) const {
  const auto recorded = quantities();
  const auto index = static_cast<std::size_t>(std::find(recorded.begin(), recorded.end(), quantity) - recorded.begin());
  if (index < columns.size()) return columns[index];
  if (index < recorded.size()) return simulated_columns[index - columns.size()];
  std::vector<std::string_view> names;
  for (const auto each : recorded) names.push_back(name_of(each));
  throw device::Error(
      fmt::format("The recording does not contain {}. It contains {}.", name_of(quantity), fmt::join(names, ", ")));
}

std::size_t Recording::end_of_stretch(std::size_t begin, std::size_t end) const {
  std::size_t last = begin + 1;
  while (last < end && periods[last] == periods[last - 1] + 1) ++last;
  return last;
}

device::ScopeSamples Recording::samples(std::size_t begin, std::size_t end) const {
  device::ScopeSamples samples{
      .signals = information.signals, .first_period = periods[begin], .count = end - begin, .values = {}};
  if (begin > 0) samples.lost_before = static_cast<std::uint64_t>(periods[begin] - periods[begin - 1] - 1);
  samples.values.reserve(samples.count * samples.signals.size());
  for (std::size_t i = begin; i < end; ++i)
    for (const auto& column : columns) samples.values.push_back(column[i]);
  return samples;
}

void Recording::append(const device::ScopeSamples& samples) {
  for (std::size_t i = 0; i < samples.count; ++i) {
    periods.push_back(samples.first_period + static_cast<std::int64_t>(i));
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(samples.values[i * columns.size() + j]);
  }
}

void Recording::keep(std::size_t begin, std::size_t end) {
  const auto cut = [&](auto& values) {
    values.resize(std::min(end, values.size()));
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(std::min(begin, values.size())));
  };
  cut(periods);
  for (auto& column : columns) cut(column);
  for (auto& column : simulated_columns) cut(column);
}

bool can_be_period(std::int64_t written) {
  constexpr std::int64_t longest_s = 1'000'000'000;
  return written >= 0 && written <= longest_s * protocol::servo_rate_Hz;
}

std::int64_t period_after(std::int64_t before, std::int64_t written) {
  return written < before ? device::WideCounter::at_or_after(before, static_cast<std::uint32_t>(written)) : written;
}

std::uint32_t step_periods_of(double written) {
  return written >= 1 && written <= protocol::servo_rate_Hz ? static_cast<std::uint32_t>(written) : 1;
}

namespace {

StoredRecording open_either(const std::filesystem::path& file) {
  auto opened = std::make_unique<std::ifstream>(file, std::ios::binary);
  std::ifstream& stream = *opened;
  if (!stream)
    throw device::Error(fmt::format("{} cannot be read. Give the name of a recording that exists.", file.string()));
  std::array<char, 8> start{};
  stream.read(start.data(), start.size());
  constexpr std::array hdf5_signature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  if (start == hdf5_signature) return open_hdf5(file);
  if (local::without_byte_order_mark({start.data(), start.size()}).starts_with('#')) {
    stream.clear();  // clears the end-of-file state of a shorter file
    stream.seekg(0);
    return open_csv(std::move(opened), file.string());
  }
  throw device::Error(fmt::format("{} is not a recording: it is neither HDF5 nor a CSV file that starts with \"# {}\".",
                                  file.string(), format_name));
}

/// Converts all texts of the file to plain text, which is safe to print, draw and copy.
void make_plain(StoredRecording& recording) {
  auto& about = recording.information;
  for (std::string* text : {&about.name, &about.note, &about.created_utc, &about.library_version, &about.library_sha256,
                            &about.image_sha256, &about.arm_sha256, &about.image_check, &about.firmware_version,
                            &about.serial_number, &about.arm})
    *text = protocol::plain_text(*text);
  for (Mark& mark : recording.marks) {
    mark.text = protocol::plain_text(mark.text);
    mark.clock_utc = protocol::plain_text(mark.clock_utc);
  }
  for (std::string& remark : recording.remarks) remark = protocol::plain_text(remark);
}

template <class Action>
auto no_memory_is_an_error(const std::filesystem::path& file, Action action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw device::Error(
        fmt::format("{} needs more memory than is free on this computer. Close other programs, or read the recording "
                    "on another computer.",
                    file.string()));
  }
}

}  // namespace

StoredRecording StoredRecording::open(const std::filesystem::path& file) {
  StoredRecording recording = no_memory_is_an_error(file, [&] { return open_either(file); });
  if (recording.size() > 0)
    for (Mark& mark : recording.marks) mark.period = period_after(recording.first_period(), mark.period);
  make_plain(recording);
  // Sorts the marks by time, because events of the device arrive later than notes of the user.
  std::ranges::stable_sort(recording.marks, {}, &Mark::period);
  recording.name = protocol::plain_text(file.stem().string());
  return recording;
}

Recording read(const std::filesystem::path& file) {
  return no_memory_is_an_error(file, [&] {
    const auto stored = StoredRecording::open(file);
    return stored.load(stored.quantities());
  });
}

namespace {

bool is_csv(const std::filesystem::path& file) { return local::has_extension(file, ".csv"); }

}  // namespace

void check_can_be_created(const std::filesystem::path& file, Existing existing) {
  if (!is_csv(file) && !local::has_extension(file, ".h5") && !local::has_extension(file, ".hdf5"))
    throw device::Error(fmt::format("{} must end in .h5 or .csv, which selects the format.", file.string()));
  if (existing == Existing::stays && std::filesystem::exists(file))
    throw device::Error(fmt::format("{} exists. Give the recording another name, or remove that file.", file.string()));
  const auto folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw device::Error(
        fmt::format("The folder {} does not exist. Create the folder, or choose another location.", folder.string()));
}

namespace {

/// Creates a new file. If the creation fails, no file remains.
std::unique_ptr<Writer> create_new(const std::filesystem::path& file, const Information& information,
                                   const std::string& name) {
  try {
    return is_csv(file) ? create_csv(file, information, name) : create_hdf5(file, information, name);
  } catch (const device::Error&) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw;
  }
}

void write_all(Writer& writer, const Recording& recording) {
  constexpr std::size_t block_samples = 4096;
  std::vector<float> simulated;
  for (std::size_t begin = 0; begin < recording.size();) {
    const std::size_t end = recording.end_of_stretch(begin, std::min(recording.size(), begin + block_samples));
    simulated.clear();
    for (std::size_t i = begin; i < end; ++i)
      for (const auto& column : recording.simulated_columns) simulated.push_back(column[i]);
    writer.append(recording.samples(begin, end), simulated);
    begin = end;
  }
  for (const auto& mark : recording.marks) writer.mark(mark);
  for (const auto& reading : recording.clock) writer.clock(reading);
  writer.end(recording.complete);
}

}  // namespace

std::unique_ptr<Writer> create(const std::filesystem::path& file, const Information& information) {
  check_can_be_created(file);
  return create_new(file, information, file.string());
}

void save(const Recording& recording, const std::filesystem::path& file) {
  check_can_be_created(file, Existing::is_replaced);
  local::ReplacedFile next(file);
  write_all(*create_new(next.path(), recording.information, file.string()), recording);
  try {
    next.replace();
  } catch (const std::system_error& error) {
    throw device::Error(
        fmt::format("{} cannot be written: {}. Give another location.", file.string(), error.code().message()));
  }
}

}  // namespace inkwell::recording
