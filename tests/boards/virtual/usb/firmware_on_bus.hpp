// The flashed firmware on the virtual chip, with a USB host. The host can observe every transaction on the cable.
// Firmware and host run in one program, so times are exact in board time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/wiring/chip.hpp"
#include "boards/virtual/usb/connector.hpp"
#include "boards/virtual/usb/root_port.hpp"
#include "protocol/reports.hpp"

namespace inkwell::virtual_usb_test {

using virtual_board::Chip;
using virtual_board::Ticks;
using virtual_board::ticks;
using virtual_board::Urb;

/// Supply and sensors have the values of a board at rest, unless a test changes these values.
class RestingCircuit final : public virtual_board::Circuit {
 public:
  void output_changed(char, unsigned, virtual_board::PinLevel, Ticks) override {}
  double analog_V(char port, unsigned pin, Ticks now) override { return voltage_V ? voltage_V(port, pin, now) : 1.65; }
  void advance(Ticks) override {}

  std::function<double(char port, unsigned pin, Ticks now)> voltage_V;
};

/// Forwards all transactions on the cable and reports them.
class Cable : public virtual_board::BusDevice {
 public:
  explicit Cable(virtual_board::BusDevice& device) : device_(device) {}
  std::uint32_t attachment() const override { return device_.attachment(); }
  void set_bus_power(bool present) override { device_.set_bus_power(present); }
  void begin_reset() override { device_.begin_reset(); }
  void end_reset() override { device_.end_reset(); }
  void start_of_frame(std::uint16_t frame_number) override {
    device_.start_of_frame(frame_number);
    if (on_start_of_frame) on_start_of_frame(frame_number);
  }
  void suspend() override { device_.suspend(); }
  void resume() override { device_.resume(); }
  virtual_board::Handshake setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) override {
    return device_.setup(address, endpoint, request);
  }
  virtual_board::Handshake out(unsigned address, unsigned endpoint, bool data1,
                               std::span<const std::byte> data) override {
    return device_.out(address, endpoint, data1, data);
  }
  virtual_board::InReply in(unsigned address, unsigned endpoint,
                            std::span<std::byte, virtual_board::full_speed_packet_maximum> data) override {
    const auto reply = device_.in(address, endpoint, data);
    if (on_in) on_in(endpoint, reply, std::span<const std::byte>(data).first(reply.length));
    return reply;
  }
  bool finish_in(unsigned endpoint) override {
    const bool done = device_.finish_in(endpoint);
    if (on_finished_in) on_finished_in(endpoint, done);
    return done;
  }

  std::function<void(std::uint16_t frame_number)> on_start_of_frame;
  std::function<void(unsigned endpoint, const virtual_board::InReply&, std::span<const std::byte>)> on_in;
  std::function<void(unsigned endpoint, bool done)> on_finished_in;

 private:
  virtual_board::BusDevice& device_;
};

/// The core's registers on the chip's bus. Reports each register write of the firmware. Reports each register read
/// before the firmware receives the value.
class ObservedRegisters final : public virtual_board::Peripheral {
 public:
  explicit ObservedRegisters(virtual_board::Peripheral& registers) : registers_(registers) {}
  std::uint32_t read(std::uint32_t offset, unsigned size) override {
    const std::uint32_t value = registers_.read(offset, size);
    if (on_read) on_read(offset, value);
    return value;
  }
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override {
    registers_.write(offset, value, size);
    if (on_write) on_write(offset);
  }
  void reset() override { registers_.reset(); }

  std::function<void(std::uint32_t offset, std::uint32_t value)> on_read;
  std::function<void(std::uint32_t offset)> on_write;

 private:
  virtual_board::Peripheral& registers_;
};

/// Returns the path of build/board/inkwell.elf.
std::filesystem::path flashed_image();

class FirmwareOnBus final : private virtual_board::RootPort::Client {
 public:
  explicit FirmwareOnBus(const std::filesystem::path& image, double host_clock_ppm = 0.0,
                         virtual_board::ChipOptions options = {});

  /// Plugs in or unplugs the cable, including VBUS. The cable is initially plugged in.
  void plug(bool in);
  /// Enumerates and configures the device. Throws std::runtime_error if the device does not appear within one second.
  void connect();
  void run_for(double time_s) { chip.run_until(chip.now() + ticks(time_s)); }
  /// Runs a control transfer and returns its status and data. Throws std::runtime_error after two seconds, twice the
  /// duration of a sector erase.
  struct Answer {
    std::int32_t status;
    std::vector<std::byte> data;
  };
  Answer control(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t index,
                 std::uint16_t length, std::vector<std::byte> data = {});
  /// From this call on, the host always has a pending request for the next pose.
  void keep_asking_for_poses();
  /// From this call on, the host always has a pending request for the next controller report.
  void keep_asking_the_controller();
  /// Selects signals for the scope and reads the scope continuously.
  void stream_scope(std::span<const protocol::Signal> signals);
  /// Sends an output report on the interrupt endpoint.
  template <class Report>
  void send_report(const Report& report) {
    send_report(std::as_bytes(std::span(&report, 1)));
  }
  void stop_asking_for_poses() { asks_for_poses_ = false; }
  /// Descriptions of the violated chip rules.
  std::vector<std::string> violations() const;

  std::function<void(const protocol::PoseReport&)> on_pose;
  std::function<void(std::span<const std::byte> report)> on_controller_report;
  std::function<void(std::span<const std::byte> frame)> on_scope_frame;
  std::function<void()> on_report_sent;

  RestingCircuit circuit;
  Chip chip;
  virtual_board::Connector connector;
  virtual_board::OtgFsDevice& core = connector.core();
  ObservedRegisters registers;
  Cable cable;
  virtual_board::RootPort port;

 private:
  void between_transactions() override {}
  void enumerated(const virtual_board::DeviceDescription&) override {}
  void detached() override {}
  void completed(Urb&& urb, std::int32_t status) override;
  void send_report(std::span<const std::byte> report);
  void ask(std::uint8_t endpoint, std::uint32_t length);

  std::uint32_t sequence_ = 0;
  bool asks_for_poses_ = false;
  std::map<std::uint32_t, Answer> answers_;
};

}  // namespace inkwell::virtual_usb_test
