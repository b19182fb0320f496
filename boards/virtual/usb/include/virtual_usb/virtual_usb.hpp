// The board's USB connector: the OTG_FS core and the boot loader, a host controller at the other end of the cable, and
// the USB/IP server that lets programs of this computer use the device.
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
  /// Listens at `where` (local::Listener); throws std::runtime_error with a sentence if it cannot. The cable is plugged
  /// in. What `chip` refers to must outlive this object. `on_request` is called from another thread when there is
  /// something to `serve`. Board time waits for no host once `is_ending` says so. `host_clock_ppm`: see HostController.
  VirtualUsb(const ChipConnections& chip, const local::SocketAddress& where, double host_clock_ppm,
             std::function<void()> on_request, std::function<bool()> is_ending);
  ~VirtualUsb();

  /// The peripheral to map at OtgFsDevice::base, and the boot loader's place.
  Connector& connector();

  /// Where the USB/IP server listens.
  const local::SocketAddress& address() const;
  std::uint16_t port() const;

  /// Takes up what the host asked for. It then takes effect in board time, which stands still meanwhile.
  void serve();
  /// Takes up everything that the host sent before this call, and waits until the host has everything that happened
  /// and asks again, as host_pace.hpp has it, but no longer than HostPace::patience.
  void settle();

  /// No program is waited for longer than HostPace::patience from now on, as where there are several.
  void limit_waiting();
  /// Called some twenty times a second while board time has been waiting for a program for longer than that, in the
  /// middle of a frame. If it returns false, board time passes on.
  void on_late_host(std::function<bool()> goes_on);
  /// The programs that have been waited for longer than that, for sentences; in lock step all that are waited for.
  std::vector<std::string> late_hosts() const;

  /// A control transfer is under way: the host waits for its answer.
  bool is_asked() const;

  /// From now on `on_stop` is called whenever lets_time_pass() becomes false, at that instant.
  void keep_in_lock_step(std::function<void()> on_stop);
  /// In lock step: each program that has imported the device waits for a report or a control transfer.
  bool lets_time_pass() const;

  /// Plugs the cable in or out. To be called on the simulation's thread, as everything here but `address` and `port`.
  void connect();
  void disconnect();
  bool connected() const;
  /// The host asks and sends nothing any more, or does again; its frames go on.
  void let_host_ask(bool asks);

  /// The host has read the device's descriptors: programs can import it.
  bool enumerated() const;
  /// A program has imported the device.
  bool imported() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::virtual_board
