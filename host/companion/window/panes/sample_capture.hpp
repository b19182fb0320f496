// The newest minute of all streamed samples.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::window {

class SampleCapture {
 public:
  static constexpr double kept_s = 60.0;
  using Block = std::shared_ptr<const device::ScopeSamples>;

  /// Adds samples and removes samples that are older than `kept_s`. A restart of the board removes all older samples.
  void add(const device::ScopeSamples& samples);
  void clear();
  bool is_empty() const { return blocks_.empty() && !open_; }
  /// Board time from the oldest sample to the newest sample.
  double duration_s() const;
  /// Returns all samples, oldest first. The blocks do not change later, so that any thread can read them.
  std::vector<Block> blocks() const;

 private:
  void close_block();
  std::int64_t end_period() const;

  std::deque<Block> blocks_;
  std::optional<device::ScopeSamples> open_;  ///< block that still grows
};

/// Converts samples to other signals. A signal without samples has the value NaN.
device::ScopeSamples converted(const device::ScopeSamples& samples, const std::vector<protocol::Signal>& signals);

/// A recording of captured samples.
struct CapturedRecording {
  std::filesystem::path file;
  recording::Information information;  ///< with the signals of the recording
  std::vector<SampleCapture::Block> blocks;
  std::vector<recording::Mark> marks;  ///< sorted by period
};

/// Writes the recording. Returns an error message; empty on success. An existing file is not overwritten.
std::string write_captured(const CapturedRecording& captured);

}  // namespace inkwell::window
