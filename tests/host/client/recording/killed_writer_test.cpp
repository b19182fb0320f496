// A program is killed at each write to its HDF5 recording.
#include <doctest/doctest.h>

#include <hdf5.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>

#include "host/client/recording/recording.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/temporary_directory.hpp"

namespace {

std::function<void()> before_each_write;

}  // namespace

/// Replaces pwrite() of the C library, which HDF5 calls.
extern "C" ssize_t pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
  if (before_each_write) before_each_write();
  return syscall(SYS_pwrite64, descriptor, bytes, count, offset);
}

using namespace inkwell;
using namespace inkwell::recording;

namespace {

constexpr std::uint32_t step_periods = 1000;  // small chunks, so that there are many
constexpr std::uint32_t samples_of_a_flush = 300, flushes = 6;

Information about() {
  return {.created_utc = "2026-01-02T03:04:05Z",
          .firmware_version = "0.1.0",
          .serial_number = "0123456789ABCDEF01234567",
          .arm = "PHANTOM Omni",
          .simulation = true,
          .parameters = protocol::default_parameters(),
          .signals = {protocol::Signal::force_N, protocol::Signal::duty_1},
          .step_periods = step_periods};
}

float value_of(std::uint32_t sample) { return 1.0f / (1.0f + static_cast<float>(sample)); }

/// Calls `at_begin` after the header is written.
void write_recording(const std::filesystem::path& file, const std::function<void()>& at_begin) {
  const auto writer = create(file, about());
  at_begin();
  for (std::uint32_t flush = 0; flush < flushes; ++flush) {
    for (std::uint32_t i = 0; i < samples_of_a_flush; ++i) {
      const std::uint32_t sample = flush * samples_of_a_flush + i;
      writer->append({.signals = about().signals,
                      .first_period = sample,
                      .count = 1,
                      .values = {value_of(sample), -value_of(sample)}},
                     {});
    }
    writer->mark({flush, "touch", device::EventKind::mark, ""});
    writer->flush();
  }
  writer->finish();
}

}  // namespace

TEST_CASE("an HDF5 recording can be opened by every program, whichever write its own was killed at") {
  const tests::TemporaryDirectory directory;
  const auto file = directory / "a.h5";
  // A copy before each write equals the file of a program killed at this write.
  int copies = 0;
  const auto copy_of = [&](int number) { return directory / (std::to_string(number) + ".h5"); };
  write_recording(file, [&] { before_each_write = [&] { std::filesystem::copy_file(file, copy_of(copies++)); }; });
  before_each_write = nullptr;
  REQUIRE(copies > 100);
  std::size_t most = 0, unreadable = 0;
  for (int i = 0; i < copies; ++i) {
    CAPTURE(i);
    // Opens the file with default properties, as h5py, Octave and MATLAB do.
    const hid_t opened = H5Fopen(copy_of(i).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(opened >= 0);
    H5Fclose(opened);
    Recording recording;
    try {
      recording = read(copy_of(i));
    } catch (const device::Error&) {
      ++unreadable;
      continue;
    }
    std::size_t wrong = 0;
    const auto& force_N = recording.column(protocol::Signal::force_N);
    for (std::uint32_t sample = 0; sample < recording.size(); ++sample)
      wrong += recording.periods[sample] != sample || force_N[sample] != value_of(sample);
    CHECK(wrong == 0);
    CHECK(recording.size() >= most);
    most = std::max(most, recording.size());
  }
  CHECK(most > samples_of_a_flush * (flushes - 1));
  // While HDF5 splits a full node of 64 chunks, the column is unreadable. In this test HDF5 splits one node per column.
  const std::size_t columns = 2 + about().signals.size();
  CHECK(unreadable <= columns);
}

TEST_CASE("the overview of a killed writer shows only samples that are in the file") {
  const tests::TemporaryDirectory directory;
  const auto file = directory / "a.h5", copy = directory / "copy.h5";
  constexpr std::size_t block = 32'768, blocks = 12;
  Information about{.parameters = protocol::default_parameters(), .signals = {protocol::Signal::force_N}};
  const auto writer = create(file, about);
  std::size_t copies = 0, unreadable = 0, wrong = 0;
  const auto check = [&] {
    std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing);
    ++copies;
    try {
      const auto recording = StoredRecording::open(copy);
      std::vector<SampleRange> ranges;
      for (std::size_t begin = 0; begin + 1024 <= recording.size(); begin += 1024)
        ranges.push_back({begin, begin + 1024});
      const std::size_t column = 0;
      const auto bands = recording.bands({&column, 1}, ranges);
      for (std::size_t i = 0; i < ranges.size(); ++i)
        wrong += bands[i][0].minimum != static_cast<double>(ranges[i].begin) ||
                 bands[i][0].maximum != static_cast<double>(ranges[i].end - 1);
    } catch (const device::Error&) {
      ++unreadable;
    }
  };
  before_each_write = check;
  for (std::size_t i = 0; i < blocks; ++i) {
    device::ScopeSamples samples{about.signals, static_cast<std::int64_t>(i * block), block, {}, 0};
    for (std::size_t j = 0; j < block; ++j) samples.values.push_back(static_cast<float>(i * block + j));
    writer->append(samples, {});
    writer->flush();
  }
  writer->finish();
  before_each_write = nullptr;
  check();
  CHECK(wrong == 0);
  CHECK(copies > 100);
  CHECK(unreadable * 20 <= copies);  // while HDF5 splits a full node of 64 chunks, as above
}
