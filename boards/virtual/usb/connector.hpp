// The USB device of the board: the OTG_FS core or the boot loader.
#pragma once

#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"
#include "boards/virtual/usb/boot_loader.hpp"

namespace inkwell::virtual_board {

/// Registers and bus interface of the OTG_FS core. While the boot loader runs, bus transactions go to the boot loader,
/// not to the core.
class Connector final : public Peripheral, public BusDevice {
 public:
  explicit Connector(const ChipConnections& chip) : core_(chip) {}

  /// See Chip::on_boot_loader.
  LoaderOrder boot_loader_order(DebugPort& memory) { return loader_.next_order(memory); }

  // Peripheral
  std::uint32_t read(std::uint32_t offset, unsigned size) override { return core_.read(offset, size); }
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override { core_.write(offset, value, size); }
  void reset() override {
    loader_.stop();
    core_.reset();
  }
  std::vector<RegisterMap> register_maps(const std::string& name, std::uint32_t at) const override {
    return core_.register_maps(name, at);
  }

  // BusDevice
  std::uint32_t attachment() const override {
    const std::uint32_t number = now().attachment();
    return number == 0 ? 0 : 2 * number + (loader_.is_running() ? 1 : 0);  // the numbers of both devices never coincide
  }
  void set_bus_power(bool present) override { core_.set_bus_power(present); }
  void begin_reset() override { now().begin_reset(); }
  void end_reset() override { now().end_reset(); }
  void start_of_frame(std::uint16_t frame_number) override { now().start_of_frame(frame_number); }
  void suspend() override { now().suspend(); }
  void resume() override { now().resume(); }
  Handshake setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) override {
    return now().setup(address, endpoint, request);
  }
  Handshake out(unsigned address, unsigned endpoint, bool data1, std::span<const std::byte> data) override {
    return now().out(address, endpoint, data1, data);
  }
  InReply in(unsigned address, unsigned endpoint, std::span<std::byte, full_speed_packet_maximum> data) override {
    return now().in(address, endpoint, data);
  }
  bool finish_in(unsigned endpoint) override { return now().finish_in(endpoint); }

  OtgFsDevice& core() { return core_; }

 private:
  BusDevice& now() { return loader_.is_running() ? static_cast<BusDevice&>(loader_) : core_; }
  const BusDevice& now() const { return loader_.is_running() ? static_cast<const BusDevice&>(loader_) : core_; }

  OtgFsDevice core_;
  BootLoader loader_;
};

}  // namespace inkwell::virtual_board
