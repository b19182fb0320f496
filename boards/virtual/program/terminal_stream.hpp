// Standard input and output, or a pseudo-terminal for programs such as picocom.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "boards/virtual/program/byte_stream.hpp"

namespace inkwell::virtual_board {

class TerminalStream final : public ByteStream {
 public:
  /// Uses standard input and output. `on_arrival`: see StreamServer.
  explicit TerminalStream(std::function<void()> on_arrival);
  /// Creates a pseudo-terminal and a symbolic link `path` to it. The destructor removes the link.
  /// @throws std::runtime_error with an error sentence if the pseudo-terminal cannot be created.
  TerminalStream(const std::filesystem::path& path, std::function<void()> on_arrival);
  ~TerminalStream() override;
  TerminalStream(const TerminalStream&) = delete;
  TerminalStream& operator=(const TerminalStream&) = delete;

  Arrived take() override;
  void send(std::string_view bytes) override;

 private:
  void start();
  void read();
  bool has_no_room();

  std::function<void()> on_arrival_;
  std::filesystem::path link_;  ///< empty: standard input and output
  int input_, output_, other_side_ = -1, ending_ = -1;
  std::mutex mutex_;
  std::string arrived_;
  std::thread thread_;
};

}  // namespace inkwell::virtual_board
