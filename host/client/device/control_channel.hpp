// Control transfers for firmware updates (DFU 1.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/client/device/address.hpp"

namespace inkwell::device {

struct UpdateRequest {
  std::uint8_t request;
  std::uint16_t value = 0;
};

/// Throws Stalled if the device refuses a request. Throws Disconnected if the device was unplugged. Throws Error if the
/// device does not answer.
class ControlChannel {
 public:
  virtual ~ControlChannel() = default;
  virtual std::vector<std::byte> read(const UpdateRequest& request, std::uint16_t length) = 0;
  virtual void write(const UpdateRequest& request, std::span<const std::byte> data) = 0;
  virtual void select_alternate(std::uint8_t alternate) = 0;
  /// Returns the name of an alternate setting, or an empty text.
  virtual std::string alternate_name(std::uint8_t alternate) = 0;
};

/// Finds ST boot loaders (0483:df11). A found boot loader may belong to another product than an arm.
std::vector<Endpoint> find_boot_loaders(const Address& address);
/// Throws NoPermission, InUse, Disconnected or Error.
std::unique_ptr<ControlChannel> open_boot_loader(const Endpoint& endpoint);
/// Requests the firmware of an arm to start the boot loader. Throws Stalled while the force is on.
void detach_firmware(const Endpoint& endpoint);

}  // namespace inkwell::device
