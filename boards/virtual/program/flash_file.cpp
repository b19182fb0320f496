#include "flash_file.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <chip/memory_map.hpp>
#include <protocol/image_identity.hpp>

namespace inkwell::virtual_board {

static_assert(flash_bytes == protocol::flash_bytes && flash_base == protocol::image_begin);
FlashFile::FlashFile(std::filesystem::path path, std::span<std::uint8_t> flash) : path_(std::move(path)) {
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored)) {
    save(flash);
    return;
  }
  std::ifstream stream(path_, std::ios::binary);
  if (!stream.is_open() || !std::filesystem::is_regular_file(path_, ignored))
    throw std::runtime_error(fmt::format(
        "--flash: {} cannot be read. Give a file of your own, or one that is not there yet.", path_.string()));
  std::vector<char> content;
  if (std::filesystem::file_size(path_, ignored) == flash.size())
    content.assign(std::istreambuf_iterator<char>(stream), {});
  if (!protocol::may_be_flash(std::as_bytes(std::span(content))))
    throw std::runtime_error(fmt::format(
        "--flash: {} is no flash of an STM32F405: that is {} bytes and begins with a firmware's vectors, or erased. "
        "It stays as it is; give another file, or one that is not there yet.",
        path_.string(), flash.size()));
  std::memcpy(flash.data(), content.data(), content.size());
}

void FlashFile::save(std::span<const std::uint8_t> flash) const {
  const std::filesystem::path fresh = path_.string() + ".new";
  std::ofstream stream(fresh, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(flash.data()), static_cast<std::streamsize>(flash.size()));
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(fresh, path_, error);
  if (stream && !error) return;
  std::error_code ignored;
  std::filesystem::remove(fresh, ignored);
  throw std::runtime_error(
      fmt::format("--flash: {} cannot be written. Look for room and rights in its folder.", path_.string()));
}

}  // namespace inkwell::virtual_board
