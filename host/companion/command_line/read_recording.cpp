#include "host/companion/command_line/read_recording.hpp"

#include <cstdio>

#include <fmt/format.h>

namespace inkwell::command_line {

recording::Recording read_recording(const std::string& file) {
  auto recording = recording::read(file);
  for (const auto& remark : recording.remarks) fmt::print(stderr, "inkwell: {}\n", remark);
  return recording;
}

}  // namespace inkwell::command_line
