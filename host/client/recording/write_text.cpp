#include "host/client/recording/write_text.hpp"

#include <system_error>

#include <fmt/format.h>

#include "host/client/device/error.hpp"
#include "host/client/local/replaced_file.hpp"

namespace inkwell::recording {

void write_text(const std::filesystem::path& file, std::string_view text) {
  try {
    local::replace_file(file, text);
  } catch (const std::system_error& error) {
    throw device::Error(fmt::format("{} cannot be written: {}. Choose another location, or free some space.",
                                    file.string(), error.code().message()));
  }
}

}  // namespace inkwell::recording
