// Parts of a long recording are read without the rest, and equal the recording in memory.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/recording/figure.hpp"
#include "host/client/recording/replay.hpp"
#include "host/client/recording/stored_recording.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::contains;
using inkwell::tests::message_of;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

namespace fs = std::filesystem;

const std::vector<Signal> signals{Signal::force_N, Signal::position_x_m, Signal::position_y_m, Signal::duty_1};
constexpr std::size_t long_samples = 1'500'000, block_samples = 4096;

float value_of(std::int64_t period, std::size_t column) {
  // The low bits look random, so the file cannot be compressed to a small part of its size.
  const auto mixed = static_cast<std::uint32_t>(period) * 2'654'435'761u + static_cast<std::uint32_t>(column) * 977u;
  return static_cast<float>(mixed >> 8u) * 1e-6f;
}

device::ScopeSamples samples_from(std::int64_t first_period, std::size_t count) {
  device::ScopeSamples samples{.signals = signals, .first_period = first_period, .count = count, .values = {}};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < signals.size(); ++j)
      samples.values.push_back(value_of(first_period + static_cast<std::int64_t>(i), j));
  return samples;
}

/// Writes samples without keeping them in memory. After every stretch, 7 samples are missing.
void write(const fs::path& file, const std::vector<std::size_t>& stretches) {
  const auto writer = create(file, {.parameters = protocol::default_parameters(), .signals = signals});
  std::int64_t period = 1000;
  for (const std::size_t stretch : stretches) {
    for (std::size_t begin = 0; begin < stretch; begin += block_samples) {
      const std::size_t count = std::min(block_samples, stretch - begin);
      writer->append(samples_from(period, count), {});
      period += static_cast<std::int64_t>(count);
    }
    period += 7;
  }
  writer->mark({1010, "touch"});
  writer->finish();
}

std::uint64_t number_in(const char* file, const std::string& name) {
  std::ifstream stream(file);
  for (std::string word; stream >> word;)
    if (word == name && stream >> word) return std::stoull(word);
  return 0;
}

std::uint64_t bytes_read() { return number_in("/proc/self/io", "rchar:"); }

void forget_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }
std::uint64_t peak_memory_bytes() { return 1024 * number_in("/proc/self/status", "VmHWM:"); }
std::uint64_t memory_bytes() { return 1024 * number_in("/proc/self/status", "VmRSS:"); }

}  // namespace

TEST_CASE("a second of one signal is read from a long recording without the rest of the file") {
  const TemporaryDirectory directory;
  const auto file = directory / "long.h5";
  write(file, {long_samples});
  REQUIRE(fs::file_size(file) > 15'000'000);
  constexpr std::uint64_t part_bytes = 1'500'000, memory_maximum_bytes = 6'000'000;

  std::uint64_t read_before = bytes_read();
  {
    const auto recording = StoredRecording::open(file);
    CHECK(recording.size() == long_samples);
    CHECK(recording.complete);
    CHECK(recording.lost() == 0);
    CHECK(recording.duration_s() == doctest::Approx((long_samples - 1) / 20'000.0));
    std::vector<float> second(20'000);
    const std::size_t begin = recording.sample_at(60.0);
    recording.read(recording.column_of(Signal::position_x_m), begin, second);
    CHECK(begin == 1'200'000);
    CHECK(second.front() == value_of(1000 + 1'200'000, 1));
    CHECK(second.back() == value_of(1000 + 1'219'999, 1));
  }
  CHECK(bytes_read() - read_before < part_bytes);

  read_before = bytes_read();
  draw_figure(StoredRecording::open(file), {.quantities = {Signal::force_N}, .from_s = 60, .to_s = 61},
              directory / "part.png");
  CHECK(bytes_read() - read_before < part_bytes);

  read_before = bytes_read();
  Replay replay(StoredRecording::open(file));
  replay.seek(70);
  CHECK(replay.advance(0.1, 0.5).blocks.size() > 1);
  CHECK(bytes_read() - read_before < part_bytes);

  const std::uint64_t memory_before = memory_bytes();
  forget_peak_memory();
  draw_figure(StoredRecording::open(file), {}, directory / "whole.png");
  CHECK(peak_memory_bytes() - std::min(peak_memory_bytes(), memory_before) < memory_maximum_bytes);
}

TEST_CASE("a stored recording with gaps equals the same recording in memory") {
  const TemporaryDirectory directory;
  const auto file = directory / "gaps.h5";
  write(file, {5000, 1, 20'000, 4096, 3});
  const auto stored = StoredRecording::open(file);
  const Recording loaded = read(file);
  REQUIRE(stored.size() == 29'100);
  REQUIRE(loaded.size() == stored.size());
  CHECK(stored.lost() == 28);
  CHECK(loaded.lost() == 28);
  CHECK(stored.marks.front().period == 1010);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < loaded.size(); ++i) wrong += stored.period(i) != loaded.periods[i];
  CHECK(wrong == 0);
  for (double at_s = -0.01; at_s < stored.duration_s() + 0.01; at_s += 0.00037)
    wrong += stored.sample_at(at_s) != loaded.sample_at(at_s);
  CHECK(wrong == 0);
  for (std::size_t begin = 0; begin < loaded.size();) {
    const std::size_t end = loaded.end_of_stretch(begin, loaded.size());
    CHECK(stored.end_of_stretch(begin, loaded.size()) == end);
    const auto expected = loaded.samples(begin, end), samples = stored.samples(begin, end);
    CHECK(samples.values == expected.values);
    CHECK(samples.first_period == expected.first_period);
    CHECK(samples.lost_before == expected.lost_before);
    begin = end;
  }
}

TEST_CASE("damage in the middle of a stored recording is an error when this part is read") {
  const TemporaryDirectory directory;
  const auto file = directory / "damaged.h5";
  write(file, {200'000});
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
    bytes << std::string(100'000, 'x');
  }
  const auto recording = StoredRecording::open(file);
  std::vector<float> values(recording.size());
  CHECK(contains(message_of<device::Error>([&] {
                   for (std::size_t column = 0; column < signals.size(); ++column) recording.read(column, 0, values);
                 }),
                 "damaged.h5 is damaged: /signals/"));
}
