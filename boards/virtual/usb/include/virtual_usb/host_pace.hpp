// The rule that synchronizes board time with the program that uses the device.
//
// A real board streams to a host controller, which polls in time however busy the computer is. Here the host is a
// program on the same computer. If board time passed while the program waits for the processor, data would be lost that
// no real board loses. Board time therefore waits for the host:
//
//   - An IN endpoint is tracked (is_kept) from its second request on. The host is then expected to submit a new request
//     after each answer.
//   - When a tracked endpoint has no request left, board time stops in the middle of the frame until the next request.
//   - Before a control socket command is executed, and before a `run` is answered, each answered request must be
//     renewed. The host then knows all past events, and its next action is reproducible.
//   - A host with several simultaneous requests streams. Board time waits for this host until it submits a request,
//     unlinks a request or disconnects. A program stopped by the computer or by a debugger therefore loses no data.
//     Commands of the control socket are answered meanwhile, but only after `patience`.
//   - A host with single requests may have read all data that it needs. A host that waits for a control transfer may
//     also pause its other requests. For both hosts the wait is limited to `patience` of wall-clock time.
//   - The same limit applies to a board in real time and to several hosts. A hung program must not delay the other
//     programs, nor the board, which then switches its force off. A real bus waits for no host.
//   - Board time does not wait at an untracked endpoint, after an unlinked or failed request, or after an expired
//     limit. The tracking of the endpoint then restarts as at an import.
//   - Control and OUT transfers are never waited for: a silent host is also silent for the firmware.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include <virtual_usb/urb.hpp>

namespace inkwell::virtual_board {

class HostPace {
 public:
  static constexpr std::chrono::seconds patience{3};

  void submitted(const Urb& urb);
  void completed(const Urb& urb, std::int32_t status);
  void unlinked(const Urb& urb);
  /// The host unlinked the transfer with this sequence number after the answer.
  void unlinked_too_late(std::uint32_t sequence);
  /// The host has changed or disconnected.
  void start_anew();

  /// A tracked endpoint has no request left.
  bool is_starved() const;
  /// A tracked endpoint has fewer requests than the host submitted there before.
  bool is_owed() const;
  /// The host streams wherever a request is missing, and no control transfer blocks it. The wait has no limit.
  bool is_waited_for_without_limit() const;
  /// The wait for the host has expired: endpoints with a missing request are no longer tracked.
  void lose_patience();
  /// A control transfer is in progress: the host waits for its answer.
  bool is_asked() const { return control_transfers_ > 0; }

  // ---- lock step (docs/virtual-board.md) ----

  /// The host waits for a requested report, or for a control transfer if it has not requested any report yet.
  bool waits_for_board() const;
  /// Like is_starved() and is_owed(), for the endpoints where the host streams.
  bool is_stream_starved() const;
  bool is_stream_owed() const;

 private:
  struct Endpoint {
    unsigned requests = 0;  ///< in progress
    unsigned asked = 0;     ///< number of requests since tracking restarted, at most 2
    unsigned most = 0;      ///< largest number of simultaneous requests since then
    std::uint32_t newest_sequence = 0;
    bool is_kept() const { return asked >= 2; }
    bool streams() const { return is_kept() && most > 1; }
  };
  void end(const Urb& urb, bool is_dropped);

  std::array<Endpoint, 16> in_endpoints_{};
  unsigned control_transfers_ = 0;
};

}  // namespace inkwell::virtual_board
