// The rule by which board time keeps step with the program that uses the device.
//
// A board on a cable streams to a host controller that asks in time, however busy the computer is. Here the host is
// a program on the same computer, and board time that ran on while the program waits for its turn would lose data
// that no real board loses. So board time waits for the host:
//
//   - An IN endpoint is kept from the second request on: the host is then expected to ask again for each answer.
//   - When a kept endpoint has no request left, board time stands still, in the middle of the frame, until the next.
//   - Before a command of the control socket is carried out and before a `run` is answered, the host has to have
//     asked again for every answer: then it knows all that happened, and what it does next is the same each time.
//   - A host that has several requests under way at a time streams. It is waited for until it asks again, takes a
//     request back or is gone: a program that the computer or a debugger stops, for however long, loses nothing.
//     Commands of the control socket are answered meanwhile, but after `patience`.
//   - One that asks one by one may have read all that it wanted, and one that waits for a control transfer may do so
//     before it asks again. These are waited for no longer than `patience` of the clock on the wall.
//   - So is every host on a board that keeps step with that clock, and where there are several: a program that hangs
//     shall not hold up the others, nor the board, which takes its force away. A real bus waits for nobody.
//   - It is not waited for at endpoints that it never kept, at which it took a request back or got an error, or after
//     it was waited for too long; there it starts anew as at an import.
//   - Control and OUT transfers are never waited for: a host that says nothing is silent, also for the firmware.
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
  /// The host took the transfer of this sequence back, which was answered already.
  void unlinked_too_late(std::uint32_t sequence);
  /// The host is another one, or gone.
  void start_anew();

  /// A kept endpoint has no request left.
  bool is_starved() const;
  /// A kept endpoint has fewer requests than the host had there before.
  bool is_owed() const;
  /// The host streams wherever it owes a request, and nothing hinders it to ask: it is waited for without a limit.
  bool is_waited_for_without_limit() const;
  /// The host was waited for long enough: endpoints at which it owes a request are no longer kept.
  void lose_patience();
  /// A control transfer is under way: the host waits for its answer.
  bool is_asked() const { return control_transfers_ > 0; }

  // ---- in lock step (docs/virtual-board.md) ----

  /// The host waits for a report that it asked for, or for a control transfer if it has not asked for any report yet.
  bool waits_for_board() const;
  /// As is_starved() and is_owed(), of the endpoints where the host streams.
  bool is_stream_starved() const;
  bool is_stream_owed() const;

 private:
  struct Endpoint {
    unsigned requests = 0;  ///< under way
    unsigned asked = 0;     ///< how often, since the host was last not waited for; counts to 2
    unsigned most = 0;      ///< requests under way at a time, since then
    std::uint32_t newest_sequence = 0;
    bool is_kept() const { return asked >= 2; }
    bool streams() const { return is_kept() && most > 1; }
  };
  void end(const Urb& urb, bool is_dropped);

  std::array<Endpoint, 16> in_endpoints_{};
  unsigned control_transfers_ = 0;
};

}  // namespace inkwell::virtual_board
