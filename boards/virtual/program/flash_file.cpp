#include "boards/virtual/program/flash_file.hpp"

#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "boards/stm32f405/core/memory_map.hpp"
#include "protocol/image_identity.hpp"

#include "boards/virtual/program/log.hpp"

namespace inkwell::virtual_board {

static_assert(flash_bytes == protocol::flash_bytes && flash_base == protocol::image_begin);
FlashFile::FlashFile(std::filesystem::path path, std::span<std::uint8_t> flash) : path_(std::move(path)) {
  try {
    file_.emplace(path_);
  } catch (const local::FileInUse& error) {
    throw std::runtime_error(fmt::format("--flash: {}", error.what()));
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("--flash: {} cannot be opened: {}. Use a file that you may write, or a new file name.",
                    path_.string(), error.code().message()));
  }
  if (const std::string warning = file_->warning(); !warning.empty()) log_line("--flash: " + warning);
  if (!file_->exists()) return;
  const std::vector<std::byte> content = file_->content(flash.size());
  if (!protocol::may_be_flash(content))
    throw std::runtime_error(fmt::format(
        "--flash: {} is not a flash image of an STM32F405, which has {} bytes and starts with a vector table or is "
        "erased. The file is not changed. Use another file, or a new file name.",
        path_.string(), flash.size()));
  std::memcpy(flash.data(), content.data(), content.size());
}

void FlashFile::save(std::span<const std::uint8_t> flash) {
  try {
    file_->replace(std::as_bytes(flash));
  } catch (const local::FileInUse& error) {
    throw std::runtime_error(fmt::format("--flash: {}", error.what()));
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("--flash: {} cannot be written: {}. Check the free space and the permissions of the folder.",
                    path_.string(), error.code().message()));
  }
}

}  // namespace inkwell::virtual_board
