// Endpoint 0: SETUP, data and status stages (USB 2.0, sections 8.5.3 and 9.3).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/usb/port.hpp"
#include "protocol/report_table.hpp"

namespace inkwell::usb {

/// The eight bytes of a SETUP packet (USB 2.0, table 9-2).
struct SetupPacket {
  std::uint8_t request_type;
  std::uint8_t request;
  std::uint16_t value;
  std::uint16_t index;
  std::uint16_t length;

  constexpr bool device_to_host() const { return (request_type & 0x80u) != 0; }
  constexpr std::uint8_t value_high() const { return static_cast<std::uint8_t>(value >> 8); }
  constexpr std::uint8_t value_low() const { return static_cast<std::uint8_t>(value); }
};

/// Result of a request.
struct Answer {
  enum class Kind : std::uint8_t {
    stall,    ///< the request is not supported or invalid
    done,     ///< no data stage; the request has been carried out
    send,     ///< IN data stage with `data`, then zeros up to `padded_size`, truncated to wLength
    receive,  ///< OUT data stage of wLength bytes, then data_received()
  };
  Kind kind = Kind::stall;
  std::span<const std::byte> data{};
  std::size_t padded_size = 0;

  static constexpr Answer stall() { return {}; }
  static constexpr Answer done() { return {Kind::done}; }
  static constexpr Answer send(std::span<const std::byte> data, std::size_t padded_size = 0) {
    return {Kind::send, data, padded_size};
  }
  static constexpr Answer receive() { return {Kind::receive}; }
};

/// Handler of the requests.
class ControlRequests {
 public:
  virtual Answer request(const SetupPacket& setup) = 0;
  /// Handles the data of an OUT data stage. The endpoint stalls the status stage if the function returns false.
  virtual bool data_received(const SetupPacket& setup, std::span<const std::byte> data) = 0;

 protected:
  ~ControlRequests() = default;
};

class ControlEndpoint {
 public:
  /// Size of the longest report without padding.
  static constexpr std::size_t buffer_size =
      std::max(sizeof(protocol::ParametersReport), sizeof(protocol::ShapesReport));
  /// A host may pad a written report to the length of the longest feature report. Bytes beyond the buffer are
  /// discarded.
  static constexpr std::size_t receive_maximum = protocol::longest_report(protocol::ReportKind::feature);
  static constexpr std::size_t buffer_alignment = alignof(protocol::ParametersReport);

  ControlEndpoint(Port& port, ControlRequests& requests) : port_(port), requests_(requests) {}

  void reset() { stage_ = Stage::idle; }
  void setup(std::span<const std::byte> packet);
  void received(std::span<const std::byte> packet);
  void sent();

  /// Buffer for an answer until the next SETUP packet.
  std::span<std::byte, buffer_size> buffer() { return buffer_; }

 private:
  enum class Stage : std::uint8_t {
    idle,        ///< waits for SETUP
    data_in,     ///< sends `remaining_` and `zeros_`; also accepts an early status packet
    data_out,    ///< collects wLength bytes in `buffer_`
    status_in,   ///< an empty packet to the host ends the request
    status_out,  ///< an empty packet from the host ends the request
  };

  void begin_data_in(const Answer& answer);
  void send_next_packet();
  void collect(std::span<const std::byte> packet);
  void send_status();
  void stall();

  Port& port_;
  ControlRequests& requests_;
  Stage stage_ = Stage::idle;
  SetupPacket setup_{};
  std::span<const std::byte> remaining_{};
  std::size_t zeros_ = 0;  ///< to be sent after `remaining_`
  bool end_with_empty_packet_ = false;
  std::size_t collected_ = 0;
  alignas(buffer_alignment) std::array<std::byte, buffer_size> buffer_{};
  std::array<std::byte, packet_size_maximum> padded_packet_{};
};

}  // namespace inkwell::usb
