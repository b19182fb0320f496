// Control transfers for firmware updates (DFU 1.1). The device runs the firmware or the chip's boot loader. The
// firmware can detach to the boot loader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/client/device/address.hpp"

namespace inkwell::device {

/// A class request to the firmware update interface.
struct UpdateRequest {
  std::uint8_t request;
  std::uint16_t value = 0;
};

/// Throws Stalled if the device refuses a request, Disconnected if the device is gone, and Error if the device does not
/// answer.
class ControlChannel {
 public:
  virtual ~ControlChannel() = default;
  virtual std::vector<std::byte> read(const UpdateRequest& request, std::uint16_t length) = 0;
  virtual void write(const UpdateRequest& request, std::span<const std::byte> data) = 0;
  virtual void select_alternate(std::uint8_t alternate) = 0;
  /// The name of an alternate setting; empty if the setting has no name.
  virtual std::string alternate_name(std::uint8_t alternate) = 0;
};

/// Finds boot loaders of ST (0483:df11). A boot loader may belong to an arm or to any other product.
std::vector<Endpoint> find_boot_loaders(const Address& address);
/// Throws NoPermission, InUse, Disconnected or Error.
std::unique_ptr<ControlChannel> open_boot_loader(const Endpoint& endpoint);
/// Asks the firmware of an arm to start the boot loader. Throws Stalled while the force is on.
void detach_firmware(const Endpoint& endpoint);

}  // namespace inkwell::device
