// One device for several programs at once, as an operating system shares it among those that open it.
//
// USB/IP knows one importer of a device. Here each program that imports it finds a device of its own:
//
//   interrupt IN   each report goes to every program that asked for one
//   bulk           belongs to the program that asked first, until it is gone or has taken its requests back; others
//                  get "busy", as from an interface that another program has claimed
//   control, OUT   go through one after the other; a second SET_CONFIGURATION is answered here, because it would start
//                  the others' endpoints anew
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
  /// The program is gone: its transfers are forgotten. With the last one the bus falls silent.
  void release(std::uint32_t session);
  void submit(std::uint32_t session, Urb&& urb);
  /// Takes a transfer back. None if it is not there (any more).
  std::optional<Urb> unlink(std::uint32_t session, std::uint32_t sequence);

 private:
  /// Where the answer to a transfer on the bus goes.
  struct Owner {
    std::uint32_t session;
    std::uint32_t sequence;  ///< by which the program knows it
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
  /// One request stands on the bus for all that wait for a report of this endpoint.
  void keep_asking(std::uint8_t endpoint);
  void stop_asking_in_vain();
  void hand_out(const Urb& report, std::int32_t status);

  Client& client_;
  DeviceDescription description_{};
  std::map<std::uint32_t, Session> sessions_;
  std::map<std::uint32_t, Owner> owners_;                ///< by sequence on the bus
  std::map<std::uint8_t, std::uint32_t> shared_on_bus_;  ///< endpoint to the sequence of its request on the bus
  std::optional<std::uint32_t> bulk_owner_;              ///< a session
  std::optional<std::uint8_t> configuration_;            ///< that the device has
  std::uint32_t sequence_ = 0;
  RootPort port_;
};

}  // namespace inkwell::virtual_board
