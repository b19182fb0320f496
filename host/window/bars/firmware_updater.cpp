#include <bars/firmware_updater.hpp>

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include <device/control_channel.hpp>
#include <firmware_update/update.hpp>

namespace inkwell::window {

FirmwareUpdater::FirmwareUpdater(std::filesystem::path image, device::Address address)
    : image_(std::move(image)), address_(std::move(address)) {
  try {
    const auto read = firmware_update::read_image(image_);
    if (read.identity) {
      const auto& version = read.identity->firmware_version;
      sight_.brings = firmware_update::describe(*read.identity);
      sight_.version = fmt::format("{}.{}.{}", version[0], version[1], version[2]);
    }
  } catch (const device::Error&) {  // then nothing is offered
  }
  worker_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

void FirmwareUpdater::look_for_boot_loader(bool looks) {
  const std::scoped_lock lock(mutex_);
  if (std::exchange(looks_, looks) != looks) changed_.notify_one();
  if (!looks) sight_.sees_boot_loader = false;
}

void FirmwareUpdater::begin(const std::string& serial_number) {
  const std::scoped_lock lock(mutex_);
  if (sight_.phase == Phase::runs) return;
  begun_ = serial_number;
  sight_.phase = Phase::runs;
  sight_.message = "beginning";
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
    bool looks = false;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, stop, 1s, [this] { return begun_.has_value(); });
      board = std::exchange(begun_, std::nullopt);
      looks = looks_;
    }
    if (board)
      update(*board);
    else if (looks)
      look();
  }
}

void FirmwareUpdater::look() {
  bool is_there = false;
  try {
    is_there = !device::find_boot_loaders(address_).empty();
  } catch (const device::Error&) {  // the session says what is wrong
  }
  const std::scoped_lock lock(mutex_);
  sight_.sees_boot_loader = is_there && looks_;
}

void FirmwareUpdater::set(Phase phase, const std::string& message, double done) {
  const std::scoped_lock lock(mutex_);
  sight_.phase = phase;
  sight_.message = message;
  sight_.done = done;
}

void FirmwareUpdater::update(const std::string& serial_number) {
  try {
    auto address = address_;
    if (address.kind == device::Address::Kind::usb) address.serial_number = serial_number;
    const auto result = firmware_update::update(
        address, firmware_update::read_image(image_),
        {.image_for = firmware_update::own_image_for,
         .on_progress = [this](std::string_view step, double done) { set(Phase::runs, std::string(step), done); }});
    if (result.firmware_version.empty())
      set(Phase::failed,
          "The firmware was written and read back, but the board does not show itself. Switch its power off and on.",
          1);
    else
      set(Phase::done, fmt::format("The board has firmware {} now.", result.firmware_version), 1);
  } catch (const std::exception& error) {
    set(Phase::failed, error.what(), 0);
  }
}

}  // namespace inkwell::window
