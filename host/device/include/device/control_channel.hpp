// Control transfers to a device for firmware updates (DFU 1.1): an arm whose firmware runs, which leaves for the boot
// loader in its chip when it is asked to, and that boot loader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <device/address.hpp>

namespace inkwell::device {

/// A request of the class, to the interface for firmware updates.
struct UpdateRequest {
  std::uint8_t request;
  std::uint16_t value = 0;
};

/// Throws Stalled if the device refuses a request, Disconnected if it is gone, Error if it does not answer.
class ControlChannel {
 public:
  virtual ~ControlChannel() = default;
  virtual std::vector<std::byte> read(const UpdateRequest& request, std::uint16_t length) = 0;
  virtual void write(const UpdateRequest& request, std::span<const std::byte> data) = 0;
  virtual void select_alternate(std::uint8_t alternate) = 0;
  /// The name of an alternate setting; empty if it has none.
  virtual std::string alternate_name(std::uint8_t alternate) = 0;
};

/// ST's boot loader in a chip (0483:df11), of an arm or of anything else.
std::vector<Endpoint> find_boot_loaders(const Address& address);
/// Throws NoPermission, InUse, Disconnected or Error.
std::unique_ptr<ControlChannel> open_boot_loader(const Endpoint& endpoint);
/// Asks the firmware of an arm to leave for the boot loader. Throws Stalled while the hand feels a force.
void detach_firmware(const Endpoint& endpoint);

}  // namespace inkwell::device
