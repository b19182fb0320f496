#include <recording/recording.hpp>

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

#include "formats.hpp"

namespace inkwell::recording {

std::uint64_t Recording::lost() const {
  if (periods.size() < 2) return 0;
  return std::uint64_t{periods.back() - periods.front()} + 1 - periods.size();
}

std::size_t Recording::sample_at(double elapsed) const {
  // A hundredth of a period, so that a time that was computed finds the sample that it was computed from.
  const double rounding_s = 0.01 / protocol::servo_rate_Hz;
  std::size_t first = 0, end = size();  // what is looked for is not before the one nor after the other
  while (first < end) {
    const std::size_t middle = first + (end - first) / 2;
    if (elapsed_s(middle) < elapsed - rounding_s)
      first = middle + 1;
    else
      end = middle;
  }
  return first;
}

const std::vector<float>& Recording::column(protocol::Signal signal) const {
  const auto& recorded = information.signals;
  const auto found = std::find(recorded.begin(), recorded.end(), signal);
  if (found != recorded.end()) return columns[static_cast<std::size_t>(found - recorded.begin())];
  std::vector<std::string_view> names;
  for (const auto each : recorded) names.push_back(info(each).name);
  throw device::Error(
      fmt::format("The recording does not hold {}. It holds {}.", info(signal).name, fmt::join(names, ", ")));
}

namespace {

Recording read_either(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw device::Error(fmt::format("{} cannot be read. Give the name of a recording that exists.", file.string()));
  std::array<char, 8> start{};
  stream.read(start.data(), start.size());
  constexpr std::array hdf5_signature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  if (start == hdf5_signature) return read_hdf5(file);
  if (start[0] == '#') return read_csv(file);
  throw device::Error(fmt::format("{} is no recording: it is neither HDF5 nor a CSV file that starts with \"# {}\".",
                                  file.string(), format_name));
}

}  // namespace

Recording read(const std::filesystem::path& file) {
  Recording recording = read_either(file);
  recording.name = file.stem().string();
  return recording;
}

void check_can_be_created(const std::filesystem::path& file) {
  const auto ending = file.extension();
  if (ending != ".h5" && ending != ".hdf5" && ending != ".csv")
    throw device::Error(fmt::format("{} must end in .h5 or .csv, which chooses the format.", file.string()));
  if (std::filesystem::exists(file))
    throw device::Error(fmt::format("{} exists. Give the recording another name, or remove that file.", file.string()));
  const auto folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw device::Error(
        fmt::format("The folder {} does not exist. Make it, or choose another place.", folder.string()));
}

std::unique_ptr<Writer> create(const std::filesystem::path& file, const Information& information) {
  check_can_be_created(file);
  return file.extension() == ".csv" ? create_csv(file, information) : create_hdf5(file, information);
}

}  // namespace inkwell::recording
