#include "host/client/firmware_update/boot_loader.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "protocol/image_identity.hpp"

namespace inkwell::firmware_update {
namespace {

enum Request : std::uint8_t { dnload = 1, upload = 2, get_status = 3, clear_status = 4, abort_request = 6 };
enum Command : std::uint8_t { set_address_command = 0x21, erase_command = 0x41 };
enum State : std::uint8_t { idle = 2, busy = 4, download_idle = 5, manifest = 7, upload_idle = 9, error_state = 10 };
constexpr std::uint8_t flash_setting = 0, options_setting = 1;
constexpr std::uint16_t first_block = 2;
constexpr std::uint32_t options_address = 0x1FFF'C000;
/// A sector erase takes at most 4 s (data sheet). The first answer contains the expected time.
constexpr unsigned longest_poll_ms = 10'000;

/// DFU 1.1, section 6.1.2.
std::string_view meaning_of(std::uint8_t status) {
  constexpr std::string_view meanings[] = {"no error",
                                           "it does not accept this address",
                                           "the file is not for this device",
                                           "the memory cannot be written",
                                           "the memory cannot be erased",
                                           "the flash is not erased",
                                           "a word cannot be programmed",
                                           "the programmed data differs",
                                           "a wrong address",
                                           "the data is incomplete",
                                           "its firmware is damaged",
                                           "the flash is read-protected",
                                           "the bus was reset",
                                           "the power was switched on",
                                           "an unknown error",
                                           "an unexpected request"};
  return status < std::size(meanings) ? meanings[status] : "an unknown error";
}

std::array<std::byte, 5> command(std::uint8_t code, std::uint32_t address) {
  return {std::byte{code}, std::byte(address & 0xFF), std::byte(address >> 8 & 0xFF), std::byte(address >> 16 & 0xFF),
          std::byte(address >> 24)};
}

/// Reads the number at the beginning of the text and removes it from the text. Returns false if the text does not begin
/// with a number.
bool take_number(std::string_view& text, std::uint32_t& number, int base) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (code != std::errc{}) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, std::string_view begin) {
  if (!text.starts_with(begin)) return false;
  text.remove_prefix(begin.size());
  return true;
}

}  // namespace

std::vector<Sector> parse_memory_layout(std::string_view name) {
  constexpr std::uint32_t sectors_maximum = 1024;
  const auto slash = name.find('/');
  if (!name.starts_with('@') || slash == std::string_view::npos) return {};
  std::string_view rest = name.substr(slash + 1);
  std::uint32_t address = 0;
  if (!take(rest, "0x") || !take_number(rest, address, 16) || !take(rest, "/")) return {};
  std::vector<Sector> sectors;
  do {
    std::uint32_t count = 0, size = 0;
    if (!take_number(rest, count, 10) || !take(rest, "*") || !take_number(rest, size, 10) || rest.empty()) return {};
    const std::uint32_t unit = rest[0] == 'K' ? 1024 : rest[0] == 'M' ? 1024 * 1024 : 1;
    rest.remove_prefix(std::min<std::size_t>(2, rest.size()));  // skips the unit and the access rights
    if (count == 0 || size == 0 || count > sectors_maximum - sectors.size() || size > 0x100'0000 / unit) return {};
    for (std::uint32_t i = 0; i < count; ++i, address += size * unit) sectors.push_back({address, size * unit});
  } while (take(rest, ","));
  return rest.empty() ? sectors : std::vector<Sector>{};
}

std::vector<Sector> sectors_of(const Image& image, const std::vector<Sector>& all) {
  std::vector<Sector> used;
  for (const Sector& sector : all)
    if (std::ranges::any_of(image.segments, [&](const Segment& segment) {
          return segment.address < sector.address + sector.bytes && sector.address < segment.end();
        }))
      used.push_back(sector);
  return used;
}

struct BootLoader::Status {
  std::uint8_t status, state;
  std::chrono::milliseconds poll;
};

BootLoader::Status BootLoader::status() {
  constexpr std::uint16_t length = 6;
  const auto answer = channel_.read({get_status}, length);
  if (answer.size() < length) throw device::Error("The boot loader's answer is too short. Reset the board.");
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(answer[i]); };
  const unsigned poll_ms = byte(1) | byte(2) << 8 | byte(3) << 16;
  return {static_cast<std::uint8_t>(byte(0)), static_cast<std::uint8_t>(byte(4)),
          std::chrono::milliseconds(std::min(poll_ms, longest_poll_ms))};
}

void BootLoader::make_idle() {
  constexpr int tries = 4;  // one request leads to idle from every state, except for some states that need two
  for (int i = 0; i < tries; ++i) {
    const auto now = status();
    if (now.state == State::idle) return;
    if (now.state == State::busy)
      std::this_thread::sleep_for(now.poll);
    else
      channel_.write({now.state == State::error_state ? Request::clear_status : Request::abort_request}, {});
  }
  throw device::Error(
      "The boot loader does not become idle. Switch the board off, then hold BOOT0 while you switch it on again.");
}

void BootLoader::start() {
  channel_.select_alternate(flash_setting);
  make_idle();
  sectors_ = parse_memory_layout(channel_.alternate_name(flash_setting));
  if (sectors_.empty() || sectors_.front().address != protocol::image_begin)
    throw device::Error("This is not the boot loader of an STM32F405. Check that the right board is plugged in.");
}

void BootLoader::wait_until_done() {
  Status now = status();
  while (now.state == State::busy) {
    std::this_thread::sleep_for(now.poll);
    now = status();
  }
  if (now.state == State::error_state || now.status != 0)
    throw device::Error(fmt::format("The boot loader reported an error: {}.", meaning_of(now.status)));
}

void BootLoader::download(std::uint16_t block, std::span<const std::byte> data) {
  channel_.write({dnload, block}, data);
  wait_until_done();
}

void BootLoader::set_address(std::uint32_t address) { download(0, command(set_address_command, address)); }

void BootLoader::erase(std::uint32_t sector_address) { download(0, command(erase_command, sector_address)); }

void BootLoader::write(std::uint32_t address, std::span<const std::byte> data) {
  set_address(address);
  download(first_block, data);
}

std::vector<std::byte> BootLoader::read(std::uint32_t address, std::size_t bytes) {
  set_address(address);
  make_idle();  // an upload starts from the idle state
  std::vector<std::byte> read;
  // Reads always use the first block after the address, because the loader scales block numbers by the request length.
  while (read.size() < bytes) {
    const auto length = static_cast<std::uint16_t>(std::min(block_bytes, bytes - read.size()));
    if (!read.empty()) {
      set_address(address + static_cast<std::uint32_t>(read.size()));
      make_idle();
    }
    const auto block = channel_.read({upload, first_block}, length);
    if (block.size() != length) throw device::Error("The boot loader did not return the requested data. Try again.");
    read.insert(read.end(), block.begin(), block.end());
    make_idle();
  }
  return read;
}

std::array<std::byte, BootLoader::option_bytes> BootLoader::read_options() {
  channel_.select_alternate(options_setting);
  make_idle();
  const auto bytes = read(options_address, option_bytes);
  std::array<std::byte, option_bytes> options{};
  std::ranges::copy(bytes, options.begin());
  channel_.select_alternate(flash_setting);
  make_idle();
  return options;
}

void BootLoader::write_options(std::span<const std::byte, option_bytes> options) {
  channel_.select_alternate(options_setting);
  make_idle();
  set_address(options_address);
  channel_.write({dnload, first_block}, options);
  try {
    wait_until_done();
  } catch (const device::Disconnected&) {  // the loader has reset the chip
  }
}

void BootLoader::leave() {
  make_idle();
  set_address(protocol::image_begin);
  channel_.write({dnload, first_block}, {});
  try {
    status();  // the loader starts the program with this answer or before it
  } catch (const device::Disconnected&) {
  }
}

}  // namespace inkwell::firmware_update
