// Writes a recording sample by sample, so that what is on the disk can be read at any moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include <device/scope_decoder.hpp>
#include <recording/information.hpp>
#include <recording/recording.hpp>

namespace inkwell::recording {

/// All members throw device::Error with a sentence when the disk does not take it; what was flushed before
/// stays readable.
class Writer {
 public:
  virtual ~Writer() = default;
  /// Samples of the signals that the recording was opened with, and beside each of them the simulated quantities that
  /// it was opened with: simulated[i * information.simulated.size() + j], empty if there are none.
  virtual void append(const device::ScopeSamples& samples, std::span<const float> simulated) = 0;
  virtual void mark(const Mark& mark) = 0;
  /// Afterwards everything appended so far survives the end of this process.
  virtual void flush() = 0;
  /// Flushes, notes that the recording is complete, and closes the file.
  virtual void finish() = 0;
};

/// What becomes of a file of the name that was given.
enum class Existing : std::uint8_t { stays, is_replaced };

/// Throws device::Error with a sentence if the ending is unknown, the file exists and stays, or its folder does not.
void check_can_be_created(const std::filesystem::path& file, Existing existing = Existing::stays);

/// The ending chooses the format: .h5 and .hdf5, or .csv. An existing file is refused, not overwritten.
std::unique_ptr<Writer> create(const std::filesystem::path& file, const Information& information);

/// Writes a whole recording. A file of that name is replaced, but only once the new one is complete.
void save(const Recording& recording, const std::filesystem::path& file);

}  // namespace inkwell::recording
