// The USB side of the board: OTG_FS core and boot loader, a host controller, and a USB/IP server. Programs on this
// computer use the device through the server.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "boards/stm32f405/core/rules.hpp"
#include "boards/virtual/usb/connector.hpp"
#include "host/client/local/socket_address.hpp"

namespace inkwell::virtual_board {

class VirtualUsb {
 public:
  /// Listens at `where` (local::Listener). Initially the cable is plugged in. Throws std::runtime_error with an error
  /// sentence if the server cannot listen. The objects in `chip` must outlive this object. The server thread calls
  /// `on_request` when requests are ready for serve(). Board time does not wait for hosts if `is_ending` returns true.
  /// `host_clock_ppm`: see HostController.
  VirtualUsb(const ChipConnections& chip, const local::SocketAddress& where, double host_clock_ppm,
             std::function<void()> on_request, std::function<bool()> is_ending);
  ~VirtualUsb();

  /// Returns the peripheral for the address OtgFsDevice::base.
  Connector& connector();

  const local::SocketAddress& address() const;
  std::uint16_t port() const;

  /// Accepts the pending requests of the host. Board time does not pass during serve().
  void serve();
  /// Accepts all requests that were sent before this call. settle() then waits for at most HostPace::patience until the
  /// host has received all answers and has renewed its requests (see host_pace.hpp).
  void settle();

  /// Limits all further waits for programs to HostPace::patience.
  void limit_waiting();
  /// Sets a callback for waits that last longer than HostPace::patience. The callback is called about 20 times per
  /// second, in the middle of a frame. If the callback returns false, board time continues.
  void on_late_host(std::function<bool()> goes_on);
  /// Returns the names of the programs for which board time has waited longer than HostPace::patience. In lock step,
  /// the result contains all programs for which board time waits.
  std::vector<std::string> late_hosts() const;

  /// Returns true while a host waits for the answer to a control transfer.
  bool has_control_transfer() const;

  /// Enables lock step. `on_stop` is called immediately when lets_time_pass() becomes false.
  void keep_in_lock_step(std::function<void()> on_stop);
  /// In lock step, returns true if each program that has imported the device waits for a report or a control transfer.
  bool lets_time_pass() const;

  /// Plugs in the cable. disconnect() unplugs the cable. All functions except address() and port() must be called on
  /// the simulation thread.
  void connect();
  void disconnect();
  bool connected() const;
  /// If `polls` is false, the host sends frames but starts no transactions.
  void set_host_polling(bool polls);

  /// Returns true if the host has read the descriptors of the device, so that programs can import the device.
  bool enumerated() const;
  bool imported() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::virtual_board
