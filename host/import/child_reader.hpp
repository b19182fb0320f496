// Reads files in a child process, because the libraries for these formats may crash on damaged files.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "host/import/file_content.hpp"
#include "host/import/format.hpp"

namespace inkwell::importer {

/// Receives the finished fraction, 0 to 1. If it returns false, the work is canceled.
using Progress = std::function<bool(double fraction)>;

struct ChildLimits {
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;
  std::chrono::seconds processor_time{120};
  std::chrono::seconds wall_time{600};  ///< a file on a lost network drive must not block forever
};

/// Starts inkwell-import, and waits for its message. Calls `progress` at least ten times per second.
/// @throws Error if the file is refused, if the child crashes or exceeds a limit, or if `progress` cancels the work.
FileContent read_in_child(const std::filesystem::path& file, Format format, const ChildLimits& limits = {},
                          const Progress& progress = {});

}  // namespace inkwell::importer
