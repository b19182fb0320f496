// The board's USB connector: OTG_FS core and boot loader, a host controller at the other end of the cable, and a USB/IP
// server. Through the server, programs on this computer use the device.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <chip/violations.hpp>
#include <local/socket_address.hpp>
#include <virtual_usb/connector.hpp>

namespace inkwell::virtual_board {

class VirtualUsb {
 public:
  /// Listens at `where` (local::Listener) with the cable plugged in. Throws std::runtime_error with a sentence on
  /// failure. The objects in `chip` must outlive this object. `on_request` is called from another thread when serve()
  /// has work. Board time waits for no host once `is_ending` returns true. `host_clock_ppm`: see HostController.
  VirtualUsb(const ChipConnections& chip, const local::SocketAddress& where, double host_clock_ppm,
             std::function<void()> on_request, std::function<bool()> is_ending);
  ~VirtualUsb();

  /// The peripheral to map at OtgFsDevice::base, including the boot loader.
  Connector& connector();

  const local::SocketAddress& address() const;
  std::uint16_t port() const;

  /// Accepts the pending requests of the host. The requests take effect in board time, which is stopped during the
  /// call.
  void serve();
  /// Accepts all requests sent before this call. Then waits until the host has received all answers and has renewed its
  /// requests (see host_pace.hpp), at most HostPace::patience.
  void settle();

  /// From now on, limits each wait for a program to HostPace::patience, as with several programs.
  void limit_waiting();
  /// Sets a callback for waits beyond HostPace::patience. The callback is called about 20 times per second, in the
  /// middle of a frame. If the callback returns false, board time continues.
  void on_late_host(std::function<bool()> goes_on);
  /// Names of the programs whose wait exceeds HostPace::patience; in lock step, of all programs that are waited for.
  std::vector<std::string> late_hosts() const;

  /// A control transfer is in progress: the host waits for its answer.
  bool is_asked() const;

  /// Enables lock step. `on_stop` is called immediately whenever lets_time_pass() becomes false.
  void keep_in_lock_step(std::function<void()> on_stop);
  /// In lock step: each program that has imported the device waits for a report or a control transfer.
  bool lets_time_pass() const;

  /// Plugs the cable in or out. All functions except `address` and `port` must be called on the simulation's thread.
  void connect();
  void disconnect();
  bool connected() const;
  /// False simulates a host without any transactions; its frames continue.
  void let_host_ask(bool asks);

  /// The host has read the device's descriptors, so programs can import the device.
  bool enumerated() const;
  bool imported() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::virtual_board
