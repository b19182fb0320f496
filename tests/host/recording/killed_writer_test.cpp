// An HDF5 recording whose program was killed, at any of the writes of its file.
#include <doctest/doctest.h>

#include <hdf5.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include <recording/recording.hpp>
#include <recording/writer.hpp>

#include <temporary_directory.hpp>

namespace {

/// Of this process, until it is as if it were killed; negative: for ever.
int writes_left = -1;

}  // namespace

/// In the place of the C library's, which HDF5 would call.
extern "C" ssize_t pwrite(int descriptor, const void* bytes, std::size_t count, off_t offset) {
  if (writes_left == 0) _exit(1);
  if (writes_left > 0) --writes_left;
  return syscall(SYS_pwrite64, descriptor, bytes, count, offset);
}

using namespace inkwell;
using namespace inkwell::recording;

namespace {

constexpr std::uint32_t step_periods = 1000;  // so that a chunk is small, and there are many
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

void write_recording(const std::filesystem::path& file, std::uint32_t flushes_wanted) {
  const auto writer = create(file, about());
  for (std::uint32_t flush = 0; flush < flushes_wanted; ++flush) {
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

/// Whether the writing came to its end before.
bool ends_after(int writes, const std::filesystem::path& file, std::uint32_t flushes_wanted) {
  std::filesystem::remove(file);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    writes_left = writes;
    write_recording(file, flushes_wanted);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status) == 0;
}

int writes_until_end(const std::filesystem::path& file, std::uint32_t flushes_wanted) {
  int few = 0, enough = 1 << 14;
  REQUIRE(ends_after(enough, file, flushes_wanted));
  while (few + 1 < enough) {
    const int middle = (few + enough) / 2;
    (ends_after(middle, file, flushes_wanted) ? enough : few) = middle;
  }
  return enough;
}

}  // namespace

TEST_CASE("an HDF5 recording can be opened by every program, whichever write its own was killed at") {
  const tests::TemporaryDirectory directory;
  const auto file = directory / "a.h5";
  const int of_the_head = writes_until_end(file, 0);
  const int all = writes_until_end(file, flushes);
  REQUIRE(all > of_the_head + 100);
  std::size_t most = 0, unreadable = 0;
  for (int writes = of_the_head; writes < all; ++writes) {
    CAPTURE(writes);
    REQUIRE_FALSE(ends_after(writes, file, flushes));
    // As h5py, Octave and MATLAB do, which ask for nothing special.
    const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(opened >= 0);
    H5Fclose(opened);
    Recording recording;
    try {
      recording = read(file);
    } catch (const device::Error&) {
      ++unreadable;
      continue;
    }
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < recording.size(); ++i)
      wrong += recording.periods[i] != i || recording.column(protocol::Signal::force_N)[i] != value_of(i);
    CHECK(wrong == 0);
    CHECK(recording.size() >= most);
    most = std::max(most, recording.size());
  }
  CHECK(most > samples_of_a_flush * (flushes - 1));
  // While HDF5 moves half of a full node of 64 chunks into a new one, a column is in between: once here, in each.
  const std::size_t columns = 2 + about().signals.size();
  CHECK(unreadable <= columns);
}
