#include "host/client/firmware_update/flash_file.hpp"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "host/client/firmware_update/boot_loader.hpp"
#include "host/client/local/owned_file.hpp"

namespace inkwell::firmware_update {
namespace {

/// Flash layout of the STM32F405 with 1 MiB, in the format of its boot loader.
constexpr char layout[] = "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg";

std::vector<std::byte> read_flash(const std::filesystem::path& name, const local::OwnedFile& file) {
  if (!file.exists()) return std::vector(protocol::flash_bytes, std::byte{0xFF});
  auto content = file.content(protocol::flash_bytes);
  if (!protocol::may_be_flash(content))
    throw device::Error(fmt::format(
        "{} is not a flash file of a virtual board: such a file has {} bytes and is erased or starts with a vector "
        "table. The file was not changed. Give the file of virtual-board --flash, or the name of a new file.",
        name.string(), protocol::flash_bytes));
  return content;
}

/// Calls `use(file)` and converts the file's errors to messages of this program.
template <class Use>
void use_flash(const std::filesystem::path& name, Use use) {
  try {
    local::OwnedFile file(name);
    use(file);
  } catch (const local::FileInUse& error) {
    throw device::Error(error.what());
  } catch (const std::system_error& error) {
    throw device::Error(fmt::format(
        "{} cannot be read or written: {}. Check the free space, and the permissions of the file and its folder.",
        name.string(), error.code().message()));
  }
}

}  // namespace

FlashFileWritten write_flash_file(const std::filesystem::path& name, const Image& given, Consent consent,
                                  const ImageFor& image_for) {
  FlashFileWritten written;
  use_flash(name, [&](local::OwnedFile& file) {
    auto flash = read_flash(name, file);
    written.before = identity_in(flash);
    written.image = (written.before ? image_for(written.before->board_name()) : std::nullopt).value_or(given);
    written.warning = file.warning();
    insist(written.image, written.before, consent);
    const auto offset = [](std::uint32_t address) {
      return static_cast<std::ptrdiff_t>(address - protocol::image_begin);
    };
    for (const Sector& sector : sectors_of(written.image, parse_memory_layout(layout)))
      std::fill_n(flash.begin() + offset(sector.address), sector.bytes, std::byte{0xFF});
    for (const Segment& segment : written.image.segments)
      std::ranges::copy(segment.bytes, flash.begin() + offset(segment.address));
    file.replace(flash);
  });
  return written;
}

}  // namespace inkwell::firmware_update
