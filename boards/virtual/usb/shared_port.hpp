// One device for several simultaneous programs, like the device sharing of an operating system.
//
// USB/IP allows one importer of a device. Here each importing program has its own view of the device:
//
//   interrupt IN   each report goes to every program that has requested one
//   bulk           belongs to the first requesting program until it disconnects or unlinks its requests; the other
//                  programs get "busy", as from a claimed interface
//   control, OUT   are executed one after the other; a second SET_CONFIGURATION is answered here, because it would
//   reset
//                  the endpoints of the other programs
//   import         resets and addresses the device for the first program only
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include <virtual_usb/root_port.hpp>

namespace inkwell::virtual_board {

class SharedPort final : private RootPort::Client {
 public:
  class Client : public PortObserver {
   public:
    virtual void completed(std::uint32_t session, Urb&& urb, std::int32_t status) = 0;
  };

  /// `host_clock_ppm`: see HostController.
  SharedPort(Scheduler& scheduler, BusDevice& device, Client& client, double host_clock_ppm);

  void plug(bool in) { port_.plug(in); }
  void let_host_ask(bool asks) { port_.let_host_ask(asks); }
  bool plugged() const { return port_.plugged(); }
  bool enumerated() const { return port_.enumerated(); }
  bool imported() const { return port_.imported(); }

  void import(std::uint32_t session);
  /// The program has disconnected: its transfers are discarded. After the last program the bus suspends.
  void release(std::uint32_t session);
  void submit(std::uint32_t session, Urb&& urb);
  /// Removes and returns a transfer. std::nullopt if the transfer does not exist or has completed.
  std::optional<Urb> unlink(std::uint32_t session, std::uint32_t sequence);

 private:
  /// Recipient of the answer to a transfer on the bus.
  struct Owner {
    std::uint32_t session;
    std::uint32_t sequence;  ///< the program's sequence number
    bool is_bulk = false;
  };
  struct Session {
    std::map<std::uint8_t, std::deque<Urb>> interrupt_requests;  ///< by endpoint
  };

  void between_transactions() override { client_.between_transactions(); }
  void enumerated(const DeviceDescription& description) override;
  void detached() override;
  void completed(Urb&& urb, std::int32_t status) override;

  bool is_of_type(const Urb& urb, TransferType type) const;
  void pass_on(const Owner& owner, Urb&& urb);
  /// Maintains one request on the bus for all programs that wait for a report of this endpoint.
  void keep_asking(std::uint8_t endpoint);
  void stop_asking_in_vain();
  void hand_out(const Urb& report, std::int32_t status);

  Client& client_;
  DeviceDescription description_{};
  std::map<std::uint32_t, Session> sessions_;
  std::map<std::uint32_t, Owner> owners_;                ///< by sequence number on the bus
  std::map<std::uint8_t, std::uint32_t> shared_on_bus_;  ///< endpoint to the sequence number of its request on the bus
  std::optional<std::uint32_t> bulk_owner_;              ///< session number
  std::optional<std::uint8_t> configuration_;            ///< present configuration of the device
  std::uint32_t sequence_ = 0;
  RootPort port_;
};

}  // namespace inkwell::virtual_board
