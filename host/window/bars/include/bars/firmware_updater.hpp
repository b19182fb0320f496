// Writes this companion's firmware into a board while the window goes on.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <device/address.hpp>

namespace inkwell::firmware_update {
struct Image;
}

namespace inkwell::window {

class FirmwareUpdater {
 public:
  /// `asks`: the board's firmware is newer, and beginning again is the consent to replace it.
  enum class Phase : std::uint8_t { idle, runs, asks, failed, done };
  /// One frame's view of it.
  struct Sight {
    Phase phase = Phase::idle;
    std::string message{};  ///< the step, the question, why it failed, or what the board has now
    double done = 0;        ///< from 0 to 1
    bool sees_boot_loader = false;
    std::string board{};    ///< that the image is for; empty: nobody knows yet which one it is
    std::string brings{};   ///< what the image is, such as "firmware 0.1.0 for omni_driver"; empty: there is none
    std::string version{};  ///< of the image; empty: there is none
  };

  /// `image` is for a board that does not say which it is. It is read anew for each update. The board is that at
  /// `address`.
  FirmwareUpdater(std::filesystem::path image, device::Address address);
  /// Waits for an update that runs: half a firmware would be left.
  ~FirmwareUpdater() = default;

  /// Once a frame: a boot loader is looked for while no device is connected.
  void look_for_boot_loader(bool looks);
  /// Once a frame: the name of the board that is there. It is remembered for an update that was cut off, after which
  /// the board cannot tell it any more.
  void meet(const std::string& board_name);
  /// Begins, unless one runs. `serial_number` may be empty: the only board.
  void begin(const std::string& serial_number);
  /// The message was read.
  void dismiss();
  Sight sight() const;

 private:
  void work(const std::stop_token& stop);
  void update(const std::string& serial_number, bool allows_downgrade);
  void look();
  /// What is brought for the board that was met.
  void read_offer();
  firmware_update::Image image_for(const std::string& board_name) const;
  void set(Phase phase, const std::string& message, double done);

  const std::filesystem::path image_;
  const device::Address address_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  Sight sight_;
  bool looks_ = false;
  std::string met_;
  bool is_offer_read_ = false;        ///< for the board that was met
  std::optional<std::string> begun_;  ///< for the board with this number
  bool allows_downgrade_ = false;     ///< that update

  std::jthread worker_;
};

}  // namespace inkwell::window
