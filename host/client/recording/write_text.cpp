#include "host/client/recording/write_text.hpp"

#include <fstream>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::recording {

void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.flush()) return;
  stream.close();
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);  // an incomplete file
  throw device::Error(fmt::format("{} cannot be written. Check the free space.", file.string()));
}

}  // namespace inkwell::recording
