// This USB device driver follows the programming model of RM0090 and uses only the core's registers.
//
// Endpoints: 0x81 interrupt IN, 0x01 interrupt OUT, 0x82 bulk IN, 0x03 bulk OUT, 64 bytes each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"

#include "tests/boards/virtual/usb/fake_board.hpp"

namespace inkwell::virtual_usb_test {

using Bytes = std::vector<std::byte>;

class FakeFirmware {
 public:
  FakeFirmware(virtual_board::OtgFsDevice& core, FakeScheduler& scheduler) : core_(core), scheduler_(scheduler) {}

  /// Starts the core and enables the pull-up of D+.
  void start();
  void handle_interrupt();

  void send_report(std::span<const std::byte> report);  ///< on 0x81
  void stream(bool on) { stream_wanted_ = on; }         ///< counting words on 0x82 after SET_CONFIGURATION
  void take_bulk(bool take);                            ///< 0x03 answers NAK while `take` is false
  void halt_bulk_in();

  // Recorded events.
  unsigned resets = 0;
  unsigned suspends = 0;
  unsigned frames = 0;
  unsigned setups = 0;
  unsigned setup_done = 0;
  unsigned reports_sent = 0;
  std::uint8_t address = 0;
  std::uint8_t configuration = 0;
  Bytes control_received;  ///< data of vendor request 2
  Bytes report_received;
  Bytes bulk_received;

  // Selected behavior.
  bool report_every_millisecond = false;
  bool answers_requests = true;
  bool clears_nak_too_early = false;
  std::uint8_t report_interval = 1;

  std::uint32_t read(std::uint32_t offset) { return core_.read(offset, 4); }
  void write(std::uint32_t offset, std::uint32_t value) { core_.write(offset, value, 4); }
  void set(std::uint32_t offset, std::uint32_t bits) { write(offset, read(offset) | bits); }

 private:
  void bus_reset();
  void stop_everything();
  void stop_in(unsigned endpoint);
  void flush_transmit(unsigned fifo);
  /// Advances time until the bits are clear.
  void wait_until_clear(std::uint32_t offset, std::uint32_t bits);
  void receive_word();
  void handle_setup();
  void answer(std::span<const std::byte> data, std::uint16_t length_asked);
  void send_control_packet();
  void stall_control();
  void arm_control_out();
  void configure();
  void arm_out(unsigned endpoint);
  void fill_stream();
  void write_packet(unsigned endpoint, std::span<const std::byte> data);

  virtual_board::OtgFsDevice& core_;
  FakeScheduler& scheduler_;
  std::array<std::byte, 8> setup_{};
  Bytes control_in_;
  std::size_t control_in_sent_ = 0;
  bool control_in_active_ = false;
  bool control_in_needs_empty_packet_ = false;
  std::size_t control_out_expected_ = 0;
  bool stream_wanted_ = false;
  bool stream_running_ = false;
  std::uint32_t stream_word_ = 0;
  std::uint32_t stream_bytes_left_ = 0;
  bool bulk_taken_ = true;
};

/// Returns byte i of the answer to vendor request 1.
constexpr std::byte pattern(std::size_t i) { return std::byte((i * 7 + 3) & 0xFF); }

}  // namespace inkwell::virtual_usb_test
