// Records a running device. Receives samples on the scope's thread and writes them on a separate thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "host/client/recording/writer.hpp"

namespace inkwell::recording {

struct RecorderStatus {
  bool running = false;
  double duration_s = 0;  ///< board time from the first sample to the last
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;  ///< lost in transmission or because the disk was too slow
  std::uint64_t bytes = 0;
  std::uint64_t free_bytes = 0;  ///< free space on its disk
  std::size_t marks = 0;
  bool is_complete = false;  ///< true once the recording has stopped and nothing is missing
  std::string error;         ///< a sentence; empty without an error
};

class Recorder {
 public:
  /// Creates the file. Throws device::Error on failure.
  Recorder(const std::filesystem::path& file, const Information& information);
  /// Finishes the recording unless `stop` was called.
  ~Recorder();

  /// Adds samples of the recording's signals; other signals are ignored. A restart of the board ends the recording.
  /// Never blocks. If more than 64 MB are queued for the disk, samples are dropped and counted as lost.
  void push(const device::ScopeSamples& samples);
  /// Marks the newest sample. Without samples, marks the first sample that arrives.
  void mark(const std::string& text);
  /// Records an event of the device at its control period. Without a period, the event is recorded like a user's mark.
  void note(const device::Event& event);
  /// Reports that samples are missing at the end, for example because the link was lost. The recording is then not
  /// complete.
  void miss_end();
  RecorderStatus status() const;
  /// Writes the remaining samples, closes the file and returns the final status.
  RecorderStatus stop();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::recording
