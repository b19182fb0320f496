// Records a running device: takes samples from the scope's thread and writes them in its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <recording/writer.hpp>

namespace inkwell::recording {

struct RecorderStatus {
  bool running = false;
  double duration_s = 0;  ///< board time from the first sample to the last
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;        ///< on the way from the device, or because the disk was too slow
  std::uint64_t bytes = 0;       ///< size of the file
  std::uint64_t free_bytes = 0;  ///< left on its disk
  std::size_t marks = 0;
  std::string error;  ///< a sentence, empty while all is well
};

class Recorder {
 public:
  /// Creates the file. Throws device::Error if it cannot.
  Recorder(const std::filesystem::path& file, const Information& information);
  /// Finishes the recording if `stop` was not called.
  ~Recorder();

  /// Samples of the signals that the recording was opened with; others are passed over. A board that was restarted
  /// ends the recording. Never waits: if the disk falls behind by more than 64 MB, samples are dropped and counted as
  /// lost.
  void push(const device::ScopeSamples& samples);
  /// Marks the newest sample; before there is one, the first.
  void mark(const std::string& text);
  /// Notes what happened to the device, at its own control period; like a mark of the user if it has none.
  void note(const device::Event& event);
  RecorderStatus status() const;
  /// Writes what is left, closes the file, and tells how it went.
  RecorderStatus stop();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::recording
