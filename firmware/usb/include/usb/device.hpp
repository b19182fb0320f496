// The board as a USB device: a HID interface for poses, commands and parameters, and a vendor interface
// for the scope. Composed in main():
//
//   usb::Device device{port, link, identity};
//   for (;;) { device.poll(); sleep until an interrupt; }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <link/link.hpp>
#include <protocol/reports.hpp>
#include <protocol/usb_identity.hpp>
#include <usb/control_endpoint.hpp>
#include <usb/port.hpp>

namespace inkwell::usb {

/// What the device tells about itself beside the tables of the protocol.
struct Identity {
  std::array<char, 24> serial_number;            ///< hexadecimal digits of the chip's unique id
  std::array<std::uint8_t, 3> firmware_version;  ///< major, minor, patch
  std::string_view board;                        ///< that this firmware is for
  std::uint32_t processor_clock_Hz;
  std::uint32_t reset_cause;  ///< RCC_CSR bits 31..24 as found at start-up
};

class Device final : private ControlRequests {
 public:
  /// All three must outlive the device. Nothing happens on the bus before the first poll().
  Device(Port& port, link::Link& link, const Identity& identity);

  /// Answers what happened on the bus and keeps the endpoints filled. Called from the main loop at least
  /// every 50 us; takes a bounded time, of which a transaction of all parameters is the longest.
  void poll();

  bool configured() const { return configuration_ != 0; }
  bool suspended() const { return suspended_; }
  /// The host asked for the boot loader, and has its answer.
  bool leaves_for_update() const { return leaves_for_update_; }

 private:
  // Requests on endpoint 0, called by control_.
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
  /// A report that can be read, in the buffer of endpoint 0 or in flash. It may be shorter than it is declared.
  std::span<const std::byte> compose(protocol::ReportId id);
  Answer get_controller_report(const SetupPacket& setup);
  Answer vendor_request(const SetupPacket& setup);

  bool force_is_on() const;
  /// Likewise: there is no force, and no command waits that could bring one.
  bool may_store() const;
  /// Whether a request with this claim may be carried out: no program drives the arm, or this one does, and then its
  /// claim is renewed. Counts refusals.
  bool is_permitted(std::uint32_t claim);
  /// The same, without counting.
  bool note_heard(std::uint32_t claim);
  bool driver_parity() const { return (link_.driver.changes() & 1u) != 0; }
  /// The claim of a program has ended: its force and shapes fade, and a force that is on falls.
  void driver_gone();
  void let_force_fall();
  void handle(const Event& event);
  void bus_reset();
  void host_gone();
  void start_endpoints();
  void stop_endpoints();
  /// A report on the interrupt endpoint.
  void take_report(std::span<const std::byte> report);
  void take_force(std::span<const std::byte> report);
  void take_shapes(std::span<const std::byte> report);
  /// The command in a report; none, with the result noted, if it is not valid.
  std::optional<protocol::CommandReport> read_command(std::span<const std::byte> report);
  /// Ignores what is no command; false if the queue has no room for one.
  bool pass_on(const std::optional<protocol::CommandReport>& command);
  /// Passes on what came by the interrupt endpoint and only then lets the next report come: while the queue is full
  /// the host is told to wait (NAK), and nothing is lost.
  void pass_on_held_command();
  void send_pose();
  void note_pose_taken();
  void offer_controller_report();
  void send_scope();
  protocol::InformationReport information() const;
  /// Its `is_known` is 0 while the bus is silent.
  protocol::FrameReport frame_report();
  /// Before the first control period: nothing but the state.
  protocol::PoseReport newest_pose();
  /// One of the endpoints beside endpoint 0.
  struct Endpoint {
    std::uint8_t address;
    EndpointType type;
    std::uint8_t interface_number;
    bool busy = false;  ///< a transfer is running
    bool halted = false;
  };
  /// Null for endpoint 0, an unknown one, and while the device is not configured.
  Endpoint* find_endpoint(std::uint16_t address);
  /// Data toggle 0, no halt, and the report or frame that was on its way from its first byte.
  void restart(Endpoint& endpoint);
  /// What the host was to fetch is out of date.
  void forget(Endpoint& endpoint);
  /// `report` stays as it is until the endpoint is not busy any more.
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
  bool force_must_fall_ = false;  ///< the driver has gone, and the command queue was full
  bool detach_asked_ = false;
  bool detach_was_refused_ = false;  ///< the last one, because of the force
  bool leaves_for_update_ = false;
  std::array<Endpoint, 4> endpoints_;
  std::optional<protocol::CommandReport> held_command_;  ///< found the queue full
  bool scope_frame_open_ = false;                        ///< the scope's oldest frame is being sent
  bool scope_wants_end_ = false;      ///< the frame's length is a multiple of 64: an empty packet ends it
  std::uint32_t pose_sequence_ = 0;   ///< of the newest report given to the port
  bool spare_waits_ = false;          ///< the newest report is a spare one, and the host has not taken it
  std::uint32_t poses_replaced_ = 0;  ///< since the host took one
  std::uint32_t poses_dropped_ = 0;
  std::uint32_t controller_taken_at_ = 0;  ///< pose_sequence_ when the host took its last report
  alignas(4) protocol::PoseReport pose_{};
  alignas(4) protocol::ControllerReport controller_{};
};

}  // namespace inkwell::usb
