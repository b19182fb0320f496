// Shares one device between several programs, as an operating system does.
//
// USB/IP allows only one importer per device. SharedPort lets several programs import the same device. The following
// rules apply.
//
//   Each interrupt IN report is sent to every program that has requested the report.
//
//   The first program with a bulk request uses the bulk endpoints until it disconnects or unlinks its requests. Bulk
//   requests of other programs fail with the status "busy".
//
//   Control and OUT transfers are executed one after the other. SharedPort itself answers a second SET_CONFIGURATION,
//   because this request would reset the endpoints of the other programs.
//
//   The import by the first program resets and addresses the device.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "boards/virtual/usb/root_port.hpp"

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
  void set_host_polling(bool polls) { port_.set_host_polling(polls); }
  bool plugged() const { return port_.plugged(); }
  bool enumerated() const { return port_.enumerated(); }
  bool imported() const { return port_.imported(); }

  void import(std::uint32_t session);
  /// Call this function when a program has disconnected. The program's transfers are discarded. After the last program
  /// has disconnected, the bus suspends.
  void release(std::uint32_t session);
  void submit(std::uint32_t session, Urb&& urb);
  /// Removes and returns a transfer, or returns std::nullopt if the transfer does not exist or has completed.
  std::optional<Urb> unlink(std::uint32_t session, std::uint32_t sequence);

 private:
  /// Recipient of the answer to a bus transfer.
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
  /// Submits one bus request on behalf of all programs that wait for a report from this endpoint.
  void keep_polling(std::uint8_t endpoint);
  void stop_useless_polling();
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
