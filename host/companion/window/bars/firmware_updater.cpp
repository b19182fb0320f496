#include "host/companion/window/bars/firmware_updater.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/control_channel.hpp"
#include "host/client/firmware_update/update.hpp"

namespace inkwell::window {

FirmwareUpdater::FirmwareUpdater(std::filesystem::path image, device::Address address)
    : image_(std::move(image)), address_(std::move(address)) {
  read_offer();
  worker_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

void FirmwareUpdater::search_boot_loader(bool searches) {
  const std::scoped_lock lock(mutex_);
  if (std::exchange(searches_, searches) != searches) changed_.notify_one();
  if (!searches) sight_.sees_boot_loader = false;
}

void FirmwareUpdater::meet(const std::string& board_name) {
  const std::scoped_lock lock(mutex_);
  if (board_name.empty() || board_name == met_ || sight_.phase == Phase::runs) return;
  met_ = board_name;
  is_offer_read_ = false;
  sight_.board.clear();  // no image is offered until the matching image is known
  sight_.brings.clear();
  sight_.version.clear();
  changed_.notify_one();
}

void FirmwareUpdater::begin(const std::string& serial_number) {
  const std::scoped_lock lock(mutex_);
  if (sight_.phase == Phase::runs) return;
  begun_ = serial_number;
  allows_downgrade_ = sight_.phase == Phase::awaits_consent;
  sight_.phase = Phase::runs;
  sight_.message = "starting";
  sight_.done = 0;
  changed_.notify_one();
}

void FirmwareUpdater::dismiss() {
  const std::scoped_lock lock(mutex_);
  if (sight_.phase != Phase::runs) sight_.phase = Phase::idle;
}

FirmwareUpdater::Sight FirmwareUpdater::sight() const {
  const std::scoped_lock lock(mutex_);
  return sight_;
}

void FirmwareUpdater::work(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  while (!stop.stop_requested()) {
    std::optional<std::string> board;
    bool searches = false, reads = false, allows_downgrade = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, stop, 1s, [this] { return begun_.has_value() || !is_offer_read_; });
      board = std::exchange(begun_, std::nullopt);
      allows_downgrade = allows_downgrade_;
      searches = searches_;
      reads = !is_offer_read_;
    }
    if (reads) read_offer();
    if (board)
      update(*board, allows_downgrade);
    else if (searches)
      search();
  }
}

firmware_update::Image FirmwareUpdater::image_for(const std::string& board_name) const {
  if (auto own = firmware_update::own_image_for(board_name)) return std::move(*own);
  if (!board_name.empty())
    throw firmware_update::NoImage(fmt::format("This companion contains no firmware for the board {}.", board_name));
  return firmware_update::read_image(image_);
}

void FirmwareUpdater::read_offer() {
  std::string board;
  {
    const std::scoped_lock lock(mutex_);
    board = met_;
    is_offer_read_ = true;
  }
  Sight offer;
  try {
    if (const auto identity = image_.empty() ? std::nullopt : image_for(board).identity) {
      const auto& version = identity->firmware_version;
      offer.brings = firmware_update::describe(*identity);
      offer.version = fmt::format("{}.{}.{}", version[0], version[1], version[2]);
    }
  } catch (const device::Error&) {  // no image is offered
  }
  const std::scoped_lock lock(mutex_);
  sight_.board = board;
  sight_.brings = offer.brings;
  sight_.version = offer.version;
}

void FirmwareUpdater::search() {
  bool is_there = false;
  try {
    is_there = !device::find_boot_loaders(address_).empty();
  } catch (const device::Error&) {  // the session reports the error
  }
  const std::scoped_lock lock(mutex_);
  sight_.sees_boot_loader = is_there && searches_;
}

void FirmwareUpdater::set(Phase phase, const std::string& message, double done) {
  const std::scoped_lock lock(mutex_);
  sight_.phase = phase;
  sight_.message = message;
  sight_.done = done;
}

void FirmwareUpdater::update(const std::string& serial_number, bool allows_downgrade) {
  using firmware_update::Consent;
  try {
    auto address = address_;
    if (address.kind == device::Address::Kind::usb) address.serial_number = serial_number;
    const auto result = firmware_update::update(
        address, image_for(sight().board),
        {.consent = allows_downgrade ? Consent::to_downgrade : Consent::none,
         .image_for = firmware_update::own_image_for,
         .on_progress = [this](std::string_view step, double done) { set(Phase::runs, std::string(step), done); }});
    if (result.firmware_version.empty())
      set(Phase::failed,
          "The firmware was written and verified, but the board did not reconnect. Switch the power of the board off "
          "and on.",
          1);
    else
      set(Phase::done, fmt::format("The board now runs firmware {}.", result.firmware_version), 1);
  } catch (const firmware_update::Downgrade& question) {
    set(Phase::awaits_consent, question.what(), 0);
  } catch (const std::exception& error) {
    set(Phase::failed, error.what(), 0);
  }
}

}  // namespace inkwell::window
