// Writes a recording sample by sample, so that the file is readable at any moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "host/client/device/scope_decoder.hpp"
#include "host/client/recording/information.hpp"
#include "host/client/recording/recording.hpp"

namespace inkwell::recording {

/// All members throw device::Error with a sentence on a write error. Flushed data remains readable.
class Writer {
 public:
  virtual ~Writer() = default;
  /// Appends samples of the recording's signals. Element i * information.simulated.size() + j of `simulated` is the
  /// simulated quantity j of sample i; `simulated` may be empty.
  virtual void append(const device::ScopeSamples& samples, std::span<const float> simulated) = 0;
  virtual void mark(const Mark& mark) = 0;
  virtual void clock(const ClockReading& reading) = 0;
  /// After this call, all appended data survives the end of the process.
  virtual void flush() = 0;
  /// Flushes, states whether the recording is complete, and closes the file.
  virtual void end(bool is_complete) = 0;
  void finish() { end(true); }
};

/// Treatment of an existing file with the same name.
enum class Existing : std::uint8_t { stays, is_replaced };

/// Throws device::Error with a sentence if the extension is unknown, if the file exists and must not be replaced, or if
/// its folder does not exist.
void check_can_be_created(const std::filesystem::path& file, Existing existing = Existing::stays);

/// The extension determines the format: .h5 and .hdf5, or .csv. An existing file is not overwritten.
std::unique_ptr<Writer> create(const std::filesystem::path& file, const Information& information);

/// Writes a complete recording. An existing file is replaced only after the new file is complete.
void save(const Recording& recording, const std::filesystem::path& file);

}  // namespace inkwell::recording
