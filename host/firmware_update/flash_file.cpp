#include <firmware_update/flash_file.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <firmware_update/boot_loader.hpp>

namespace inkwell::firmware_update {
namespace {

/// Of the STM32F405 with 1 MiB, as its boot loader says.
constexpr char layout[] = "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg";

std::vector<std::byte> read_flash(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return std::vector(protocol::flash_bytes, std::byte{0xFF});
  // A folder has no bytes to read, and a device perhaps no end of them.
  std::vector<char> content;
  if (std::filesystem::is_regular_file(file, code)) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw device::Error(fmt::format("{} cannot be read. Is it yours?", file.string()));
    if (std::filesystem::file_size(file, code) == protocol::flash_bytes)
      content.assign(std::istreambuf_iterator<char>(stream), {});
  }
  const auto bytes = std::as_bytes(std::span(content));
  if (!protocol::may_be_flash(bytes))
    throw device::Error(fmt::format(
        "{} is no flash of a virtual board: that is {} bytes and begins with a firmware's vectors, or erased. It stays "
        "as it is. Give the file of virtual-board --flash, or one that is not there yet.",
        file.string(), protocol::flash_bytes));
  return {bytes.begin(), bytes.end()};
}

/// Whole or not at all.
void replace(const std::filesystem::path& file, std::span<const std::byte> content) {
  auto unfinished = file;
  unfinished += ".new";
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
  stream.close();
  std::error_code code;
  if (stream) std::filesystem::rename(unfinished, file, code);
  if (stream && !code) return;
  std::filesystem::remove(unfinished, code);
  throw device::Error(fmt::format("{} cannot be written. Is its disk full, or its folder not yours?", file.string()));
}

}  // namespace

FlashFileWritten write_flash_file(const std::filesystem::path& file, const Image& given, Consent consent,
                                  const ImageFor& image_for) {
  auto flash = read_flash(file);
  const auto before = identity_in(flash);
  Image image = (before ? image_for(before->board_name()) : std::nullopt).value_or(given);
  insist(image, before, consent);
  const auto offset = [](std::uint32_t address) {
    return static_cast<std::ptrdiff_t>(address - protocol::image_begin);
  };
  for (const Sector& sector : sectors_of(image, parse_memory_layout(layout)))
    std::fill_n(flash.begin() + offset(sector.address), sector.bytes, std::byte{0xFF});
  for (const Segment& segment : image.segments)
    std::ranges::copy(segment.bytes, flash.begin() + offset(segment.address));
  replace(file, flash);
  return {before, std::move(image)};
}

}  // namespace inkwell::firmware_update
