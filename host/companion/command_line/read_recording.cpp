#include "host/companion/command_line/read_recording.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "host/client/local/output.hpp"

namespace inkwell::command_line {

recording::StoredRecording open_recording(const std::string& file) {
  auto recording = recording::StoredRecording::open(file);
  for (const auto& remark : recording.remarks) local::print_error("inkwell: {}\n", remark);
  return recording;
}

}  // namespace inkwell::command_line
