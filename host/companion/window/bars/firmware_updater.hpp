// Updates the board's firmware in a background thread.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host/client/device/address.hpp"

namespace inkwell::firmware_update {
struct Image;
}

namespace inkwell::window {

class FirmwareUpdater {
 public:
  /// In the phase `awaits_consent`, the board's firmware is newer. A second call of begin() permits the downgrade.
  enum class Phase : std::uint8_t { idle, runs, awaits_consent, failed, done };
  /// State of the updater during a frame.
  struct Sight {
    Phase phase = Phase::idle;
    std::string message{};  ///< step, question, error, or the new firmware version
    double done = 0;        ///< progress from 0 to 1
    bool sees_boot_loader = false;
    std::string board{};    ///< board that the image belongs to; empty: not known yet
    std::string brings{};   ///< description of the image, such as "firmware 0.1.0 for omni_driver"; empty: no image
    std::string version{};  ///< version of the image; empty: no image
  };

  /// `image` is the default for boards without a reported name. Each update reads the image file again. `address` is
  /// the address of the board.
  FirmwareUpdater(std::filesystem::path image, device::Address address);
  /// Waits for the end of a running update, because an interrupted update leaves incomplete firmware on the board.
  ~FirmwareUpdater() = default;

  /// Call once per frame. Searches for a boot loader while `searches` is true.
  void search_boot_loader(bool searches);
  /// Call once per frame with the name of the connected board. The updater stores the name, because a board with
  /// incomplete firmware does not report its name.
  void meet(const std::string& board_name);
  /// Starts an update, unless an update is running. An empty `serial_number` selects the only connected board.
  void begin(const std::string& serial_number);
  /// Closes the message.
  void dismiss();
  Sight sight() const;

 private:
  void work(const std::stop_token& stop);
  void update(const std::string& serial_number, bool allows_downgrade);
  void search();
  /// Reads the image for the connected board.
  void read_offer();
  firmware_update::Image image_for(const std::string& board_name) const;
  void set(Phase phase, const std::string& message, double done);

  const std::filesystem::path image_;
  const device::Address address_;
  mutable std::mutex mutex_;  // protects the members below
  std::condition_variable_any changed_;
  Sight sight_;
  bool searches_ = false;
  std::string met_;
  bool is_offer_read_ = false;        ///< for the connected board
  std::optional<std::string> begun_;  ///< serial number of the board to update
  bool allows_downgrade_ = false;     ///< applies to the current update

  std::jthread worker_;
};

}  // namespace inkwell::window
