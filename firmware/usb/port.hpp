// Hardware interface of a USB device with one full-speed port.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace inkwell::usb {

inline constexpr std::size_t packet_size_maximum = 64;

enum class EndpointType : std::uint8_t { control = 0, bulk = 2, interrupt = 3 };

/// Bus event. Events are reported in their order on the bus.
struct Event {
  enum class Kind : std::uint8_t {
    reset,     ///< bus reset: address 0, all endpoints except 0 closed
    suspend,   ///< no traffic for 3 ms: the host is in suspend or the cable is unplugged
    resume,    ///< traffic has resumed
    setup,     ///< SETUP packet of eight bytes in `data`; the previous transfer on endpoint 0 is over
    received,  ///< OUT packet of `length` bytes on `endpoint`; the next packet is accepted after receive()
    sent,      ///< the host has read the whole transfer of send() on `endpoint`
  };

  Kind kind = Kind::reset;
  std::uint8_t endpoint = 0;  ///< number, without the direction bit
  std::uint8_t length = 0;    ///< used bytes of `data`
  alignas(4) std::array<std::byte, packet_size_maximum> data{};
};

/// Bus frame of 1 ms, timed by the host's clock. Fields in cycles refer to the processor's cycle counter.
struct BusFrame {
  std::uint16_t number = 0;         ///< 0..2047, from the start-of-frame packet
  std::uint32_t count = 0;          ///< bus frames since the port was started
  std::uint32_t begin_cycles = 0;   ///< cycle counter at the start of the bus frame
  std::uint32_t length_cycles = 0;  ///< measured time between two start-of-frame packets
  std::uint32_t now_cycles = 0;     ///< cycle counter at the time of this call
};

/// Endpoint hardware. Endpoint addresses have bit 7 set for IN. Every call returns within microseconds.
///
/// Endpoint 0 is open after a reset and always accepts SETUP. While a SETUP event is pending, send(), receive() and
/// stall() have no effect on endpoint 0, because they would answer an older request.
class Port {
 public:
  /// Writes the next event to `event`. Returns false if there is no event. next_event() continues the transfers in
  /// progress.
  virtual bool next_event(Event& event) = 0;

  /// The device calls this function when SET_ADDRESS arrives, before the status stage. The hardware determines when the
  /// port applies the address.
  virtual void set_address(std::uint8_t address) = 0;

  /// Opens an endpoint with data toggle 0, without halt and without a transfer. A transfer in progress is canceled
  /// without a `sent` event.
  virtual void open(std::uint8_t endpoint_address, EndpointType type) = 0;

  /// Closes an endpoint. A transfer in progress is canceled without a `sent` event.
  virtual void close(std::uint8_t endpoint_address) = 0;

  /// The endpoint answers STALL from this call on. Endpoint 0 answers STALL in both directions until the next SETUP.
  virtual void stall(std::uint8_t endpoint_address) = 0;

  /// Cancels a transfer in progress, ends a stall, and sets the data toggle to 0.
  virtual void clear_stall(std::uint8_t endpoint_address) = 0;

  /// Starts an IN transfer. `data` may be empty. `data` must not change until `sent` or cancel(). The port sends no
  /// additional empty packet after the last full packet. Only one transfer may be in progress. On endpoint 0 a transfer
  /// is at most one packet.
  virtual void send(std::uint8_t endpoint_address, std::span<const std::byte> data) = 0;

  /// Cancels an IN transfer in progress, without a `sent` event. Returns false if there was no transfer, or if the host
  /// had already read the transfer.
  virtual bool cancel(std::uint8_t endpoint_address) = 0;

  /// Accepts one OUT packet on the endpoint.
  virtual void receive(std::uint8_t endpoint_address) = 0;

  /// Returns the current bus frame, or nothing while the bus is silent.
  virtual std::optional<BusFrame> bus_frame() = 0;

 protected:
  ~Port() = default;
};

}  // namespace inkwell::usb
