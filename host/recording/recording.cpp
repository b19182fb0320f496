#include <recording/recording.hpp>

#include <array>
#include <fstream>

#include <fmt/format.h>

#include "formats.hpp"

namespace inkwell::recording {

std::uint64_t Recording::lost() const {
  if (periods.size() < 2) return 0;
  return std::uint64_t{periods.back() - periods.front()} + 1 - periods.size();
}

Recording read(const std::filesystem::path& file) {
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

std::unique_ptr<Writer> create(const std::filesystem::path& file, const Information& information) {
  if (std::filesystem::exists(file))
    throw device::Error(fmt::format("{} exists. Give the recording another name, or remove that file.", file.string()));
  const auto ending = file.extension();
  if (ending == ".h5" || ending == ".hdf5") return create_hdf5(file, information);
  if (ending == ".csv") return create_csv(file, information);
  throw device::Error(fmt::format("{} must end in .h5 or .csv, which chooses the format.", file.string()));
}

}  // namespace inkwell::recording
