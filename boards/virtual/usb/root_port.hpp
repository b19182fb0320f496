// Host port of the USB cable: connection, reset, enumeration, import and suspend.
//
//   Start:    detached -> debouncing -> resetting -> reading descriptors -> suspended.
//   Import:   suspended -> resetting -> addressing -> in use.
//   Release:  in use -> suspended.
//
// USB/IP has no messages for bus reset and device address. An importer expects a device that has just been reset and
// addressed, so RootPort resets and addresses the device at each import.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "boards/virtual/usb/host_controller.hpp"

namespace inkwell::virtual_board {

/// Events on a port. The callbacks run on the simulation thread.
class PortObserver {
 public:
  virtual ~PortObserver() = default;
  virtual void between_transactions() = 0;
  virtual void enumerated(const DeviceDescription& description) = 0;
  virtual void detached() = 0;
};

class RootPort final : private HostController::Client {
 public:
  /// Callbacks to the client.
  class Client : public PortObserver {
   public:
    virtual void completed(Urb&& urb, std::int32_t status) = 0;
  };

  /// `host_clock_ppm`: see HostController.
  RootPort(Scheduler& scheduler, BusDevice& device, Client& client, double host_clock_ppm = 0.0);

  void plug(bool in);
  void set_host_polling(bool polls) { controller_.set_polling(polls); }
  bool plugged() const { return plugged_; }
  bool enumerated() const { return state_ >= State::suspended; }
  bool imported() const { return state_ > State::suspended; }

  /// Resets and addresses the device for a new user. The call is allowed only if enumerated() is true and imported() is
  /// false.
  void import();
  /// Call this function when the user has disconnected. The user's transfers are discarded, and the bus suspends.
  void release();
  void submit(Urb&& urb);
  /// Removes and returns a transfer, or returns std::nullopt if the transfer does not exist or has completed.
  std::optional<Urb> unlink(std::uint32_t sequence);

 private:
  enum class State : std::uint8_t {
    detached,
    debouncing,
    first_reset,
    first_recovery,
    reading_packet_size,
    packet_size_known,
    second_reset,
    second_recovery,
    addressing,
    address_recovery,
    reading_device,
    reading_configuration_length,
    reading_configuration,
    // enumerated from here on
    suspended,
    // imported from here on
    import_reset,
    import_recovery,
    import_addressing,
    import_address_recovery,
    in_use,
  };

  void between_transactions() override;
  void frame() override;
  void completed(Urb&& urb, std::int32_t status) override;

  void enter(State state, unsigned frames);
  void begin_reset(State state);
  void end_reset(State recovery);
  void start_control_transfer(std::uint8_t request_type, std::uint8_t request, std::uint16_t value,
                              std::uint16_t length);
  void request_descriptor(std::uint8_t type, std::uint8_t index, std::uint16_t length);
  void time_over();
  void answered(const Urb& urb);
  void detach();
  void follow_standard_request(const Urb& urb);

  BusDevice& device_;
  Client& client_;
  bool plugged_ = false;
  std::uint32_t attachment_ = 0;
  State state_ = State::detached;
  unsigned frames_left_ = 0;  ///< 0: the state has no time limit
  bool bus_in_reset_ = false;
  DeviceDescription description_{};
  const ConfigurationDescription* configuration_ = nullptr;
  std::uint16_t control_packet_maximum_ = 8;
  std::vector<Urb> held_;  ///< transfers of the importer, until the device has its address
  HostController controller_;
};

}  // namespace inkwell::virtual_board
