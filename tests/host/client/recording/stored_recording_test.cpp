// Parts of a long recording are read without the rest, and equal the recording in memory.
#include <doctest/doctest.h>

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/recording/figure.hpp"
#include "host/client/recording/overview.hpp"
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

  read_before = bytes_read();
  replay.select({Signal::force_N, Signal::supply_V});
  replay.seek(20);
  const auto force_only = replay.advance(0.1, 0.5).blocks;
  CHECK(force_only.size() > 1);
  CHECK(force_only.front().signals == std::vector{Signal::force_N});
  CHECK(bytes_read() - read_before < part_bytes / 4);

  const std::uint64_t memory_before = memory_bytes();
  forget_peak_memory();
  read_before = bytes_read();
  draw_figure(StoredRecording::open(file), {}, directory / "whole.png");
  CHECK(bytes_read() - read_before < fs::file_size(file) / 10);  // the overview instead of the samples
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
    const auto expected = loaded.samples(begin, end), samples = stored.samples(begin, end, stored.information.signals);
    CHECK(samples.values == expected.values);
    CHECK(samples.first_period == expected.first_period);
    CHECK(samples.lost_before == expected.lost_before);
    begin = end;
  }
}

TEST_CASE("the overview of a recording equals its samples, and files without overview are read sample by sample") {
  const TemporaryDirectory directory;
  const auto file = directory / "gaps.h5", old = directory / "old.h5";
  write(file, {5000, 1, 200'000, 4096, 3, 100'000, 77});
  fs::copy_file(file, old);
  {
    const hid_t opened = H5Fopen(old.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    REQUIRE(H5Ldelete(opened, "/overview", H5P_DEFAULT) >= 0);
    H5Fclose(opened);
  }
  const StoredRecording with = StoredRecording::open(file), without = StoredRecording::open(old);
  const Recording loaded = read(file);
  const std::size_t columns[] = {2, 0};
  std::vector<SampleRange> ranges{{0, with.size()}, {0, 0}, {with.size() - 1, with.size()}, {1, 5001}, {4999, 7000}};
  for (std::size_t begin = 0; begin + 3000 < with.size(); begin += 2777) ranges.push_back({begin, begin + 3000});
  const auto quick = with.bands(columns, ranges), exact = without.bands(columns, ranges);
  REQUIRE(quick.size() == ranges.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      const auto [begin, end] = ranges[i];
      const auto& values = loaded.columns[columns[j]];
      const auto extremes_of = [&](std::size_t first, std::size_t last) {
        const auto [least, largest] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                                          values.begin() + static_cast<std::ptrdiff_t>(last));
        return std::pair(static_cast<double>(*least), static_cast<double>(*largest));
      };
      if (begin == end) {
        wrong += !std::isnan(quick[i][j].minimum) || !std::isnan(exact[i][j].mean);
        continue;
      }
      const auto [least, largest] = extremes_of(begin, end);
      wrong += exact[i][j].minimum != least || exact[i][j].maximum != largest;
      // The widened range ends within one block, and not after a gap.
      std::size_t first = begin, last = end;
      while (first > 0 && first % overview_block_samples != 0 && loaded.periods[first] == loaded.periods[first - 1] + 1)
        --first;
      while (last < loaded.size() && last % overview_block_samples != 0 &&
             loaded.periods[last] == loaded.periods[last - 1] + 1)
        ++last;
      const auto [widest_least, widest_largest] = extremes_of(first, last);
      wrong += !(quick[i][j].minimum >= widest_least && quick[i][j].minimum <= least);
      wrong += !(quick[i][j].maximum <= widest_largest && quick[i][j].maximum >= largest);
      wrong += std::abs(quick[i][j].mean - exact[i][j].mean) > 0.1 * (largest - least);
    }
  CHECK(wrong == 0);
}

TEST_CASE("an overview that is longer than the recording is cut, and a damaged one is refused") {
  const TemporaryDirectory directory;
  const auto file = directory / "a.h5";
  write(file, {10'000});
  const std::size_t column = 0;
  const SampleRange all{0, 10'000};
  const auto change = [&](auto action) {
    const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    action(opened);
    H5Fclose(opened);
  };
  const auto expected = StoredRecording::open(file).bands({&column, 1}, {&all, 1}).front().front();
  change([](hid_t opened) {
    const hid_t blocks = H5Dopen2(opened, "/overview/blocks", H5P_DEFAULT);
    const hsize_t many = 1'000'000;
    H5Dwrite(blocks, H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &many);
    H5Dclose(blocks);
  });
  CHECK(StoredRecording::open(file).bands({&column, 1}, {&all, 1}).front().front().maximum == expected.maximum);
  change([](hid_t opened) {
    H5Ldelete(opened, "/overview/signals/force_N", H5P_DEFAULT);
    const hsize_t count = 300;
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    H5Dclose(
        H5Dcreate2(opened, "/overview/signals/force_N", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  });
  std::size_t force = 0;
  {
    const auto damaged = StoredRecording::open(file);
    force = damaged.column_of(Signal::force_N);
    CHECK(contains(message_of<device::Error>([&] {
                     damaged.bands({&force, 1}, {&all, 1});
                   }),
                   "/overview/signals/force_N must be real numbers"));
  }
  change([](hid_t opened) { H5Ldelete(opened, "/overview/signals/force_N", H5P_DEFAULT); });
  CHECK(StoredRecording::open(file).bands({&force, 1}, {&all, 1}).front().front().maximum > 0);
}

TEST_CASE("a part of a long CSV recording is read without the rest of the file") {
  const TemporaryDirectory directory;
  const auto file = directory / "long.csv";
  constexpr std::size_t samples = 400'000;
  write(file, {250'000, samples - 250'000});
  REQUIRE(fs::file_size(file) > 15'000'000);
  constexpr std::uint64_t memory_maximum_bytes = 4'000'000, part_bytes = 1'500'000;
  const std::uint64_t memory_before = memory_bytes();
  forget_peak_memory();
  const auto recording = StoredRecording::open(file);
  CHECK(recording.size() == samples);
  CHECK(recording.lost() == 7);
  CHECK(recording.complete);
  const std::uint64_t read_before = bytes_read();
  std::vector<float> second(20'000);
  recording.read(recording.column_of(Signal::position_x_m), 240'000, second);
  CHECK(second.front() == value_of(1000 + 240'000, 1));
  CHECK(second.back() == value_of(1000 + 7 + 259'999, 1));
  CHECK(bytes_read() - read_before < part_bytes);
  draw_figure(recording, {}, directory / "whole.png");
  CHECK(peak_memory_bytes() - std::min(peak_memory_bytes(), memory_before) < memory_maximum_bytes);
}

TEST_CASE("a damaged line of a CSV recording is named when this part is read") {
  const TemporaryDirectory directory;
  const auto file = directory / "damaged.csv";
  {
    std::ofstream text(file);
    text << "# inkwell recording = 1\ntime_s,force_N\n";
    for (int i = 0; i < 10'000; ++i) text << i * 5e-5 << (i == 7000 ? ",nonsense\n# mark 5 = a\n" : ",1\n");
  }
  const auto recording = StoredRecording::open(file);
  CHECK(recording.marks.size() == 1);
  CHECK(recording.value(0, 0) == 1.0f);
  const std::string problem = message_of<device::Error>([&] { recording.value(0, 7500); });
  CHECK(contains(problem, "is damaged in line 7003: \"nonsense\" is not a number"));
  CHECK(message_of<device::Error>([&] { recording.value(0, 7501); }) == problem);
  CHECK(recording.value(0, 9999) == 1.0f);
  fs::resize_file(file, 2000);
  CHECK(contains(message_of<device::Error>([&] { recording.value(0, 5000); }), "has changed since it was opened"));
  std::ofstream(directory / "endless.csv") << "# inkwell recording = 1\n" << std::string(40'000'000, ' ');
  CHECK(contains(message_of<device::Error>([&] { StoredRecording::open(directory / "endless.csv"); }),
                 "line 2: the line is too long"));
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
