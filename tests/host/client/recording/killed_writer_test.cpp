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
