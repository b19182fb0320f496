// Interface between a host controller and one full-speed device: line states and single transactions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "boards/stm32f405/core/interfaces.hpp"

namespace inkwell::virtual_board {

inline constexpr Ticks bit_ticks = ticks_per_s / 12'000'000;

/// Largest data packet of a full-speed device. Only isochronous packets may exceed 64 bytes.
inline constexpr std::size_t full_speed_packet_maximum = 1023;

/// Result of a transaction at the host (USB 2.0, section 8.4.5).
enum class Handshake : std::uint8_t {
  ack,      ///< the data was transferred
  nak,      ///< not ready
  stall,    ///< the endpoint is halted, or the request is not supported
  nothing,  ///< no answer or a damaged one: the host counts an error and retries
};

/// Answer of the device to an IN token. The first `length` bytes of `data` are valid if `handshake` is `ack`.
struct InReply {
  Handshake handshake = Handshake::nothing;
  bool data1 = false;
  std::size_t length = 0;
};

class BusDevice {
 public:
  virtual ~BusDevice() = default;

  /// Returns 0 while the pull-up on D+ is off, otherwise the number of the attachment. Each attachment has a different
  /// number.
  virtual std::uint32_t attachment() const = 0;
  /// Applies or removes VBUS.
  virtual void set_bus_power(bool present) = 0;

  virtual void begin_reset() = 0;
  virtual void end_reset() = 0;
  virtual void start_of_frame(std::uint16_t frame_number) = 0;
  /// Reports that the bus has been idle for 3 ms.
  virtual void suspend() = 0;
  /// Reports that the host drives resume signaling.
  virtual void resume() = 0;

  virtual Handshake setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) = 0;
  virtual Handshake out(unsigned address, unsigned endpoint, bool data1, std::span<const std::byte> data) = 0;
  /// Answers an IN token. The returned packet is on the wire until finish_in() is called.
  virtual InReply in(unsigned address, unsigned endpoint, std::span<std::byte, full_speed_packet_maximum> data) = 0;
  /// Reports that the host has acknowledged the packet from in(). Returns false if a FIFO flush or a reset has damaged
  /// the packet.
  virtual bool finish_in(unsigned endpoint) = 0;
};

}  // namespace inkwell::virtual_board
