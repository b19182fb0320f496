#include "host/client/firmware_update/update.hpp"

#include <algorithm>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "host/client/device/device.hpp"

namespace inkwell::firmware_update {
namespace {

using namespace std::chrono_literals;
using device::Address;
using device::Endpoint;

/// A board changes between firmware and boot loader in half a second. A virtual board on a busy computer needs a few
/// seconds.
constexpr auto change_patience = 20s;
constexpr auto look_again = 50ms;
/// In this time the system grants access to a new device or finds its driver.
constexpr auto system_patience = 5s;

/// `is_chosen` is true if the image was chosen based on the board's erased image.
std::string how_to_go_on(const Image& image, bool is_chosen) {
  return fmt::format(
      "The board is in its boot loader, without a complete firmware, and its bridges are off. Leave its power on and "
      "run the same command again{}: the command continues the update. If the power was off, first hold BOOT0 while "
      "you switch the power on.",
      is_chosen ? fmt::format(", now with {}, because the board can no longer report its name", image.file.string())
                : "");
}

Address without_number(const Address& address) { return {.kind = address.kind, .server = address.server}; }

std::vector<Endpoint> arms_at(const Address& address) {
  return address.kind == Address::Kind::usbip ? device::find_usbip_devices(address.server) : device::find_arms(address);
}

/// Returns the boot loaders at the address. A serial number in the address excludes boot loaders with other serial
/// numbers.
std::vector<Endpoint> loaders_at(const Address& address) {
  auto loaders = device::find_boot_loaders(address);
  if (!address.serial_number.empty())
    std::erase_if(loaders, [&](const auto& each) { return each.serial_number != address.serial_number; });
  return loaders;
}

[[noreturn]] void complain_of_number(const std::vector<Endpoint>& arms, const std::vector<Endpoint>& loaders) {
  if (arms.empty() && loaders.empty())
    throw device::NoDevice(
        "Neither an arm nor a boot loader was found. Plug the board in. If its firmware does not run, hold its button "
        "BOOT0 while you switch its power on.");
  std::string list;
  for (const auto& each : arms) list += fmt::format(" {} (runs),", each.serial_number);
  for (const auto& each : loaders) list += fmt::format(" {} (boot loader),", each.serial_number);
  list.pop_back();
  throw device::NoDevice(
      fmt::format("{} boards are plugged in. Choose one with --serial NUMBER:{}.", arms.size() + loaders.size(), list));
}

template <class Attempt>
auto wait_for(Attempt attempt) -> decltype(attempt()) {
  const auto deadline = std::chrono::steady_clock::now() + change_patience;
  for (;;) {
    if (auto found = attempt()) return found;
    if (std::chrono::steady_clock::now() > deadline) return {};
    std::this_thread::sleep_for(look_again);
  }
}

/// Returns nothing if a restarting server or device does not answer. The caller repeats the call.
template <class Attempt>
auto if_it_answers(Attempt attempt) -> decltype(attempt()) {
  try {
    return attempt();
  } catch (const device::NoPermission&) {
    throw;
  } catch (const device::Error&) {
    return {};
  }
}

/// Waits for a device that the system has just detected. A refusal by the system is an error only if the refusal
/// persists.
template <class Attempt>
auto wait_for_admitted(Attempt attempt) -> decltype(attempt()) {
  std::optional<std::chrono::steady_clock::time_point> refused_at;
  return wait_for([&]() -> decltype(attempt()) {
    try {
      return if_it_answers(attempt);
    } catch (const device::NoPermission&) {
      const auto now = std::chrono::steady_clock::now();
      if (!refused_at) refused_at = now;
      if (now - *refused_at > system_patience) throw;
      return {};
    }
  });
}

/// Restarts the board from its firmware into the boot loader.
Endpoint detach(const Endpoint& arm, const Address& address) {
  std::set<std::string> known;
  for (const auto& each : device::find_boot_loaders(address))
    if (each.kind == Endpoint::Kind::usb) known.insert(each.serial_number);
  try {
    device::detach_firmware(arm);
  } catch (const device::Stalled&) {
    throw device::Error(
        "The board does not start its boot loader while the force is on. Switch the force off first: inkwell force "
        "off.");
  }
  const auto loader = wait_for_admitted([&]() -> std::optional<Endpoint> {
    for (auto& each : device::find_boot_loaders(address))
      if (!known.contains(each.serial_number)) return each;
    return {};
  });
  if (loader) return *loader;
  throw device::Error(
      "The board has stopped its firmware, but its boot loader was not found. Switch the board's power off and on "
      "again: its old firmware is still installed.");
}

/// Refuses an unsuitable image before the board enters its boot loader, based on the board name in the firmware's
/// report. If the firmware does not answer, the flash is checked later.
void insist_for(const Endpoint& arm, const Image& image, const UpdateOptions& options) {
  const auto board = if_it_answers([&] {
    const auto report = device::Device(device::open_transport(arm)).information().report;
    const auto& version = report.firmware_version;
    return std::optional(
        protocol::image_identity(protocol::board_name(report.board), version[0], version[1], version[2]));
  });
  if (!board || !board->is_there()) return;
  insist(options.image_for(board->board_name()).value_or(image), board, options.consent);
}

/// Finds the boot loader of the selected board, and the serial numbers of the other arms.
struct Found {
  Endpoint loader;
  std::set<std::string> other_arms;
};
Found find_loader(const Address& address, const Image& image, const UpdateOptions& options) {
  const auto arms = arms_at(address);
  const auto loaders = loaders_at(address);
  if (arms.size() + loaders.size() != 1) complain_of_number(arms, loaders);
  Found found;
  for (const auto& each : arms_at(without_number(address))) found.other_arms.insert(each.serial_number);
  if (!loaders.empty()) {
    found.loader = loaders.front();
    return found;
  }
  found.other_arms.erase(arms.front().serial_number);
  insist_for(arms.front(), image, options);
  options.on_progress("starting the boot loader of the board", 0);
  found.loader = detach(arms.front(), address);
  return found;
}

/// A part of the image, at most one block long and without gaps. The first block of the flash is the last in the list.
struct Block {
  std::uint32_t address;
  std::span<const std::byte> bytes;
};
std::vector<Block> blocks_of(const Image& image) {
  std::vector<Block> blocks;
  for (const Segment& segment : image.segments)
    for (std::size_t at = 0; at < segment.bytes.size(); at += BootLoader::block_bytes)
      blocks.push_back(
          {segment.address + static_cast<std::uint32_t>(at),
           std::span(segment.bytes).subspan(at, std::min(BootLoader::block_bytes, segment.bytes.size() - at))});
  std::rotate(blocks.begin(), blocks.begin() + 1, blocks.end());
  return blocks;
}

/// Steps of a flash write.
class Writing {
 public:
  Writing(BootLoader& loader, const Image& image, const UpdateOptions& options)
      : loader_(loader), options_(options), sectors_(sectors_of(image, loader.sectors())), blocks_(blocks_of(image)) {}

  void erase() {
    for (const Sector& sector : sectors_) {  // the first sector first: see update.hpp
      step(fmt::format("erasing: {} KiB at 0x{:08x}", sector.bytes / 1024, sector.address));
      loader_.erase(sector.address);
      done_ += 0.3 / static_cast<double>(sectors_.size());
    }
  }
  void write_and_verify() {
    const auto last = blocks_.size() - 1;
    for (std::size_t i = 0; i < last; ++i) write(blocks_[i]);
    for (std::size_t i = 0; i < last; ++i) verify(blocks_[i]);
    write(blocks_[last]);
    verify(blocks_[last]);
  }

 private:
  void step(const std::string& text) {
    if (options_.is_cancelled()) throw device::Error("Stopped at your request.");
    options_.on_progress(text, std::min(done_, 0.99));
  }
  void write(const Block& block) {
    step(fmt::format("writing: 0x{:08x}", block.address));
    loader_.write(block.address, block.bytes);
    done_ += 0.4 / static_cast<double>(blocks_.size());
  }
  void verify(const Block& block) {
    step(fmt::format("reading back: 0x{:08x}", block.address));
    const auto read = loader_.read(block.address, block.bytes.size());
    const auto difference = std::ranges::mismatch(read, block.bytes);
    if (difference.in2 != block.bytes.end())
      throw device::Error(fmt::format("The flash differs from the image at 0x{:08x}. The flash may be worn.",
                                      block.address + (difference.in2 - block.bytes.begin())));
    done_ += 0.3 / static_cast<double>(blocks_.size());
  }

  BootLoader& loader_;
  const UpdateOptions& options_;
  const std::vector<Sector> sectors_;
  const std::vector<Block> blocks_;
  double done_ = 0;
};

/// Reads the versions of the new firmware. The versions stay empty if the board does not restart in time.
void check_result(const Address& address, const std::set<std::string>& other_arms, UpdateResult& result) {
  wait_for([&] {
    return if_it_answers([&] {
      for (const auto& arm : arms_at(without_number(address))) {
        if (arm.kind == Endpoint::Kind::usb && other_arms.contains(arm.serial_number)) continue;
        device::Device device(device::open_transport(arm));
        const auto information = device.information();
        result.serial_number = information.serial_number;
        result.firmware_version = information.firmware_version;
        result.protocol_version = information.protocol_version;
        return true;
      }
      return false;
    });
  });
}

}  // namespace

std::optional<std::array<std::byte, BootLoader::option_bytes>> with_brown_out_level_3(
    const std::array<std::byte, BootLoader::option_bytes>& options) {
  constexpr std::byte level_bits{0x0C}, unprotected{0xAA};
  if (options[1] != unprotected)
    throw device::Error("The chip's option bytes show that its flash is protected. They were not changed.");
  if ((options[0] & level_bits) == std::byte{0}) return {};
  auto changed = options;
  changed[0] &= ~level_bits;  // the other bits are retained: some of them would lock the chip permanently
  return changed;
}

Written write_image(BootLoader& loader, const Image& image, const UpdateOptions& options) {
  Written written;
  loader.start();
  written.before = identity_in(loader.read(protocol::image_begin, identity_end));
  try {
    if (written.before)
      written.image = options.image_for(written.before->board_name()).value_or(image);
    else
      written.image = image;
    insist(written.image, written.before, options.consent);
  } catch (const device::Error&) {
    if (written.before) loader.leave();  // starts the identified firmware
    throw;
  }
  if (options.is_cancelled()) {
    if (written.before) loader.leave();
    throw device::Error("Stopped at your request. Nothing was changed.");
  }
  const auto options_before = loader.read_options();
  const auto options_wanted = with_brown_out_level_3(options_before);
  try {
    Writing writing(loader, written.image, options);
    writing.erase();
    writing.write_and_verify();
  } catch (const device::Error& error) {
    throw Interrupted(
        fmt::format("{} {}", error.what(), how_to_go_on(written.image, written.image.file != image.file)));
  }
  options.on_progress(
      options_wanted ? "setting the brown-out level, and starting the firmware" : "starting the firmware", 0.99);
  if (options_wanted) loader.write_options(*options_wanted);
  if (!options_wanted) loader.leave();
  written.has_set_brown_out = options_wanted.has_value();
  return written;
}

UpdateResult update(const Address& address, const Image& image, const UpdateOptions& options) {
  // An image that suits no board is refused before the board enters its boot loader.
  insist(image, {}, options.consent);
  UpdateResult result;
  const Found found = find_loader(address, image, options);
  {
    const auto channel = device::open_boot_loader(found.loader);
    BootLoader loader(*channel);
    Written written = write_image(loader, image, options);
    result.before = written.before;
    result.written = std::move(written.image);
    result.has_set_brown_out = written.has_set_brown_out;
  }
  options.on_progress("waiting for the board to restart", 0.99);
  check_result(address, found.other_arms, result);
  options.on_progress("done", 1);
  return result;
}

}  // namespace inkwell::firmware_update
