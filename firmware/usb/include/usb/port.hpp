// What the USB device needs from the hardware: one full-speed port with its endpoints.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace inkwell::usb {

inline constexpr std::size_t packet_size_maximum = 64;

enum class EndpointType : std::uint8_t { control = 0, bulk = 2, interrupt = 3 };

/// Something that happened on the bus, in the order in which it happened.
struct Event {
  enum class Kind : std::uint8_t {
    reset,     ///< the host reset the bus: address 0, every endpoint but 0 closed
    suspend,   ///< no traffic for 3 ms: the host sleeps or the cable is out
    resume,    ///< traffic again
    setup,     ///< eight bytes of a SETUP packet in `data`; what endpoint 0 was doing is over
    received,  ///< an OUT packet of `length` bytes on `endpoint`; the next one waits for receive()
    sent,      ///< the transfer given to send() on `endpoint` was taken by the host to its last packet
  };

  Kind kind = Kind::reset;
  std::uint8_t endpoint = 0;  ///< number, without the direction bit
  std::uint8_t length = 0;    ///< bytes of `data` that are used
  alignas(4) std::array<std::byte, packet_size_maximum> data{};
};

/// A frame of the bus: what the host does in one of its milliseconds. Cycles are those of the processor's counter.
struct BusFrame {
  std::uint16_t number = 0;         ///< 0..2047, as it came with the start of frame
  std::uint32_t count = 0;          ///< of frames since the port started
  std::uint32_t begin_cycles = 0;   ///< the counter at the start of frame
  std::uint32_t length_cycles = 0;  ///< from one start of frame to the next, as measured
  std::uint32_t now_cycles = 0;     ///< the counter when this was asked for
};

/// Endpoint hardware. Endpoints go by their address, bit 7 set for IN. Every call returns at once or
/// after a wait that is bounded to microseconds. Endpoint 0 is open from reset on and always takes SETUP; while
/// a SETUP waits to be taken from next_event(), send(), receive() and stall() do nothing on endpoint 0, because
/// they answer an older one.
class Port {
 public:
  /// The next event; false if there is none. Also moves the running transfers on.
  virtual bool next_event(Event& event) = 0;

  /// Called when SET_ADDRESS arrives, before its status stage; the port takes the address into use when
  /// its hardware wants it.
  virtual void set_address(std::uint8_t address) = 0;

  /// Opens an endpoint with data toggle 0, not halted, without a transfer: no `sent` comes for one that was running.
  virtual void open(std::uint8_t endpoint_address, EndpointType type) = 0;

  /// Closes an endpoint; a running transfer is forgotten, and no `sent` comes for it.
  virtual void close(std::uint8_t endpoint_address) = 0;

  /// Answers STALL from now on. On endpoint 0 in both directions, until the next SETUP.
  virtual void stall(std::uint8_t endpoint_address) = 0;

  /// Forgets a running transfer, ends a stall and starts again with data toggle 0.
  virtual void clear_stall(std::uint8_t endpoint_address) = 0;

  /// Starts an IN transfer. `data` must stay as it is until `sent` or cancel(); it may be empty. It goes
  /// out as full packets and a shorter last one; no empty packet is added. One transfer at a time. On
  /// endpoint 0 at most one packet.
  virtual void send(std::uint8_t endpoint_address, std::span<const std::byte> data) = 0;

  /// Forgets a running IN transfer: no `sent` comes for it any more. False if there was none, or the host had taken it
  /// already.
  virtual bool cancel(std::uint8_t endpoint_address) = 0;

  /// Lets the endpoint take one OUT packet.
  virtual void receive(std::uint8_t endpoint_address) = 0;

  /// The frame that runs; none while the bus is silent.
  virtual std::optional<BusFrame> frame() = 0;

 protected:
  ~Port() = default;
};

}  // namespace inkwell::usb
