// The board as a USB device. The board has a HID interface for poses, commands and parameters, and a vendor interface
// for the scope. The board has a controller interface and a firmware update interface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "firmware/link/link.hpp"
#include "firmware/usb/control_endpoint.hpp"
#include "firmware/usb/port.hpp"
#include "protocol/reports.hpp"
#include "protocol/usb_identity.hpp"

namespace inkwell::usb {

/// Identity of the device.
struct Identity {
  std::array<char, 24> serial_number;            ///< hexadecimal digits of the chip's unique id
  std::array<std::uint8_t, 3> firmware_version;  ///< major, minor, patch
  std::string_view board;                        ///< target board of this firmware
  std::uint32_t processor_clock_Hz;
  std::uint32_t reset_cause;  ///< RCC_CSR bits 31..24, as read at start-up
  std::uint32_t image_check;  ///< checksum in the last word of the flashed image
};

class Device final : private ControlRequests {
 public:
  /// The arguments must outlive the device. The device is inactive on the bus before the first poll().
  Device(Port& port, link::Link& link, const Identity& identity);

  /// Handles bus events and refills the endpoints. The main loop calls poll() at least every 50 us.
  void poll();

  bool configured() const { return configuration_ != 0; }
  bool suspended() const { return suspended_; }
  /// Returns true after the host has requested the boot loader and has received the answer.
  bool leaves_for_update() const { return leaves_for_update_; }

 private:
  // Requests on endpoint 0. Called by control_.
  Answer request(const SetupPacket& setup) override;
  bool data_received(const SetupPacket& setup, std::span<const std::byte> data) override;

  Answer standard_request(const SetupPacket& setup);
  Answer get_descriptor(const SetupPacket& setup);
  Answer get_status(const SetupPacket& setup);
  Answer change_halt(const SetupPacket& setup, bool halted);
  Answer set_configuration(const SetupPacket& setup);
  Answer string_descriptor(std::uint8_t index);
  Answer send_byte(std::uint8_t value);
  Answer class_request(const SetupPacket& setup);
  Answer hid_request(const SetupPacket& setup);
  Answer firmware_update_request(const SetupPacket& setup);
  Answer get_report(const SetupPacket& setup);
  /// Returns a report. The report is in the buffer of endpoint 0 or in flash. The report may be shorter than its
  /// declared size.
  std::span<const std::byte> compose(protocol::ReportId id);
  Answer get_controller_report(const SetupPacket& setup);
  Answer vendor_request(const SetupPacket& setup);

  bool force_is_on() const;
  /// Returns true if the force is off and no queued command can switch the force on.
  bool may_store() const;
  /// Returns true if a request with `claim` is permitted. Requests of the driver are permitted. All requests are
  /// permitted while there is no driver. Renews the claim of the driver, and counts refusals.
  bool check_claim(std::uint32_t claim);
  /// Returns the same result as is_permitted(), but does not count refusals.
  bool note_heard(std::uint32_t claim);
  bool driver_parity() const { return (link_.driver.changes() & 1u) != 0; }
  /// Call this function after the claim of a program has ended. Fades the force and the shapes of the former driver,
  /// and switches the force off.
  void driver_gone();
  void let_force_fall();
  void handle(const Event& event);
  void bus_reset();
  void host_gone();
  void start_endpoints();
  void stop_endpoints();
  /// Handles a report on the interrupt endpoint.
  void take_report(std::span<const std::byte> report);
  void take_force(std::span<const std::byte> report);
  void take_local_model(std::span<const std::byte> report);
  void take_shapes(std::span<const std::byte> report);
  /// Returns the command in a report. If the command is invalid, returns nothing and records the result.
  std::optional<protocol::CommandReport> read_command(std::span<const std::byte> report);
  /// Queues a command. Ignores an empty argument. Returns false if the queue is full.
  bool pass_on(const std::optional<protocol::CommandReport>& command);
  /// Queues the command from the interrupt endpoint, and then accepts the next report. While the queue is full, the
  /// endpoint answers NAK, so the host waits and no report is lost.
  void pass_on_held_command();
  void send_pose();
  void note_pose_sent();
  void offer_controller_report();
  void send_scope();
  protocol::InformationReport information() const;
  /// `is_known` is 0 while the bus is silent.
  protocol::FrameReport frame_report();
  /// Before the first control period, only the state in the report is valid.
  protocol::PoseReport newest_pose();
  /// An endpoint other than endpoint 0.
  struct Endpoint {
    std::uint8_t address;
    EndpointType type;
    std::uint8_t interface_number;
    bool busy = false;  ///< a transfer is in progress
    bool halted = false;
  };
  /// Returns null for endpoint 0, for an unknown endpoint, and while the device is not configured.
  Endpoint* find_endpoint(std::uint16_t address);
  /// Restarts the endpoint with data toggle 0 and without halt. An interrupted report or frame is sent again from its
  /// first byte.
  void restart(Endpoint& endpoint);
  /// Cancels an outdated transfer.
  void forget(Endpoint& endpoint);
  /// `report` must not change while the endpoint is busy.
  template <class Report>
  void send(Endpoint& endpoint, const Report& report) {
    endpoint.busy = true;
    port_.send(endpoint.address, std::as_bytes(std::span(&report, 1)));
  }

  Port& port_;
  link::Link& link_;
  const Identity& identity_;
  const std::int32_t pose_loading_cycles_, spare_pose_lead_cycles_, pose_replacing_cycles_, period_cycles_;
  ControlEndpoint control_;
  std::uint8_t configuration_ = 0;
  std::array<std::uint8_t, protocol::usb::interface_count> idle_rates_{};
  bool suspended_ = false;
  bool force_must_fall_ = false;  ///< the driver is gone, and the command queue was full
  bool detach_requested_ = false;
  bool detach_was_refused_ = false;  ///< the last detach request was refused, because the force was on
  bool leaves_for_update_ = false;
  std::array<Endpoint, 4> endpoints_;
  std::optional<protocol::CommandReport> held_command_;  ///< waits for space in the queue
  bool scope_frame_open_ = false;                        ///< the scope's oldest frame is being sent
  bool scope_wants_end_ = false;      ///< an empty packet must end the frame, because its length is a multiple of 64
  std::uint32_t pose_sequence_ = 0;   ///< sequence of the newest report passed to the port
  bool spare_waits_ = false;          ///< the newest report is a spare pose that the host has not read
  std::uint32_t poses_replaced_ = 0;  ///< poses replaced since the host last read a pose
  std::uint32_t poses_dropped_ = 0;
  std::uint32_t controller_taken_at_ = 0;  ///< pose_sequence_ at which the host read the last controller report
  alignas(4) protocol::PoseReport pose_{};
  alignas(4) protocol::ControllerReport controller_{};
};

}  // namespace inkwell::usb
