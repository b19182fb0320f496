// USB device port that uses the OTG_FS core in device mode (RM0090, chapter OTG_FS).
//
// The driver uses no USB interrupt. The control interrupt wakes the main loop every 50 us, the duration of one packet.
// A scope transfer takes 5 ms, so the bus is idle between two transfers for at most 1 % of the time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/drivers/claims.hpp"
#include "firmware/drivers/otg_fs/frame_clock.hpp"
#include "firmware/registers/peripherals.hpp"
#include "firmware/usb/port.hpp"

namespace inkwell::drivers {

class OtgFs final : public usb::Port {
 public:
  static constexpr std::array claims{peripheral<registers::OTG_FS_GLOBAL>(),
                                     peripheral<registers::OTG_FS_DEVICE>(),
                                     peripheral<registers::OTG_FS_PWRCLK>(),
                                     peripheral<registers::OTG_FS_FIFO>(),
                                     peripheral<registers::TIM2>(),
                                     pin(board::facts.usb_minus),
                                     pin(board::facts.usb_plus),
                                     pin(board::facts.usb_supply)};

  /// `frames` is the initial count of bus frames.
  constexpr explicit OtgFs(std::uint32_t frames = 0) : frame_clock_(frames) {}

  /// Sets up pins, clock and core in 26 ms. After start(), next_event() connects the D+ pull-up while the cable
  /// supplies VBUS. The 48 MHz clock must already run (clocks.hpp). Returns false if the core does not answer.
  [[nodiscard]] bool start();

  bool next_event(usb::Event& event) override;
  void set_address(std::uint8_t address) override;
  void open(std::uint8_t endpoint_address, usb::EndpointType type) override;
  void close(std::uint8_t endpoint_address) override;
  void stall(std::uint8_t endpoint_address) override;
  void clear_stall(std::uint8_t endpoint_address) override;
  void send(std::uint8_t endpoint_address, std::span<const std::byte> data) override;
  bool cancel(std::uint8_t endpoint_address) override;
  void receive(std::uint8_t endpoint_address) override;
  std::optional<usb::BusFrame> bus_frame() override { return frame_clock_.newest(); }

 private:
  static constexpr unsigned in_endpoints = 4;   ///< 0 control, 1 HID, 2 scope, 3 controller
  static constexpr unsigned out_endpoints = 2;  ///< 0 control, 1 HID

  struct InTransfer {
    std::span<const std::byte> remaining{};  ///< bytes that are not yet in the FIFO
    bool running = false;
  };
  struct OutPacket {
    std::array<std::byte, usb::packet_size_maximum> data{};
    std::uint8_t length = 0;
  };

  void follow_cable();
  void bus_reset();
  bool next_sent(usb::Event& event);
  bool next_received(usb::Event& event);
  bool take_received_word(usb::Event& event);
  void pass_on_setup(usb::Event& event);
  bool next_suspend_or_resume(usb::Event& event);
  void answer_control();
  /// Returns false if a SETUP packet may have invalidated the answer.
  bool arm_control();
  void begin_send(unsigned endpoint);
  void begin_receive(unsigned endpoint);
  void fill(unsigned endpoint);
  /// Returns false if no transfer was in progress or if the host has received the whole transfer.
  bool stop_in(unsigned endpoint);
  void empty_receive_fifo();

  FrameClock frame_clock_;
  std::array<InTransfer, in_endpoints> in_{};
  std::array<OutPacket, out_endpoints> out_{};
  std::array<std::byte, 8> setup_{};
  bool control_send_waits_ = false;
  bool control_receive_waits_ = false;
  bool control_stall_waits_ = false;
  bool setup_waits_ = false;  ///< `setup_` has been read, but not the end of the SETUP stage
  /// If true, the setup-done word is lost, because NAK was cleared directly after the SETUP packet had arrived.
  bool setup_done_is_lost_ = false;
  bool pulled_up_ = false;
  bool suspended_ = false;
};

}  // namespace inkwell::drivers
