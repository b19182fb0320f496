// Rules for synchronizing board time with the host. The host is the program that uses the USB device.
//
// A real board streams to a host controller, which polls in time even if the computer is busy. The host of a virtual
// board is a program on the same computer. A program may have to wait for CPU time. If board time passed while the
// program waits, data would be lost. Board time therefore waits for the host.
//
//   An IN endpoint is tracked (is_kept) from its second request on. The host must submit a new request after each
//   answer from a tracked endpoint.
//
//   When a tracked endpoint has no request left, board time stops in the middle of the frame until the next request.
//
//   Each answered request must be renewed before a control socket command is executed or a `run` is answered. A host
//   that has renewed its requests has processed all past events, so the next action of the host is reproducible.
//
//   A host with several simultaneous requests is a streaming host. Board time waits without limit until a streaming
//   host submits a request, unlinks a request or disconnects. A program that a debugger has stopped therefore loses no
//   data. If the wait exceeds `patience`, control socket commands are executed during the wait.
//
//   A host with single requests may have read all data that it needs. A host that waits for a control transfer may
//   pause its other requests. For a host with single requests or with a pending control transfer, board time waits at
//   most `patience` of wall-clock time.
//
//   If the board runs in real time, or if several programs use the device, every wait is limited to `patience`. Without
//   the limit, a hung program would delay the other programs, and the board could not switch the force off.
//
//   Board time does not wait at an untracked endpoint, after an unlinked or failed request, or after an expired limit.
//   After an unlinked or failed request, or after an expired limit, tracking of the endpoint restarts.
//
//   Board time never waits for control or OUT transfers, because the firmware must detect a silent host.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "boards/virtual/usb/urb.hpp"

namespace inkwell::virtual_board {

class HostPace {
 public:
  static constexpr std::chrono::seconds patience{3};

  void submitted(const Urb& urb);
  void completed(const Urb& urb, std::int32_t status);
  void unlinked(const Urb& urb);
  /// Call this function when the host has unlinked a transfer that had already been answered.
  void unlinked_too_late(std::uint32_t sequence);
  /// Call this function when the device is detached. Tracking restarts for all endpoints.
  void restart();

  /// Returns true if a tracked endpoint has no pending request.
  bool is_starved() const;
  /// Returns true if a tracked endpoint has fewer pending requests than its previous maximum.
  bool is_owed() const;
  /// Returns true if no control transfer is pending and the host streams at every endpoint with a missing request.
  bool is_waited_for_without_limit() const;
  /// Call this function when the time limit of a wait has expired. Endpoints with a missing request are no longer
  /// tracked.
  void lose_patience();
  /// Returns true while the host waits for the answer to a control transfer.
  bool has_control_transfer() const { return control_transfers_ > 0; }

  // ---- lock step (docs/virtual-board.md) ----

  /// Returns true if the host waits for a requested report, or for a control transfer if the host has never requested a
  /// report.
  bool waits_for_board() const;
  /// Variants of is_starved() and is_owed() for endpoints at which the host streams.
  bool is_stream_starved() const;
  bool is_stream_owed() const;

 private:
  struct Endpoint {
    unsigned requests = 0;   ///< in progress
    unsigned requested = 0;  ///< number of requests since tracking restarted, at most 2
    unsigned most = 0;       ///< largest number of simultaneous requests since then
    std::uint32_t newest_sequence = 0;
    bool is_kept() const { return requested >= 2; }
    bool streams() const { return is_kept() && most > 1; }
  };
  void end(const Urb& urb, bool is_dropped);

  std::array<Endpoint, 16> in_endpoints_{};
  unsigned control_transfers_ = 0;
};

}  // namespace inkwell::virtual_board
