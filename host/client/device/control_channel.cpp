#include "host/client/device/control_channel.hpp"

#include <libusb-1.0/libusb.h>

#include <array>

#include "protocol/usb_identity.hpp"

#include "host/client/device/transports.hpp"
#include "host/client/device/usb_descriptors.hpp"
#include "host/client/device/usb_handle.hpp"
#include "host/client/device/usbip_connection.hpp"

namespace inkwell::device {
namespace {

namespace identity = protocol::usb;

constexpr std::uint8_t class_in = 0xA1, class_out = 0x21, interface_out = 0x01;
constexpr std::uint8_t boot_loader_interface = 0, set_interface = 11;
/// DFU 1.1, sections 3 and 6.1.2.
constexpr std::uint8_t detach_request = 0, get_status_request = 3, status_vendor_error = 0x0B;
constexpr std::uint16_t status_length = 6;
constexpr unsigned timeout_ms = 20'000;  // longer than any sector erase
constexpr char in_use[] =
    "Another program is updating this board's firmware. Wait until the update is finished, or close that program.";
constexpr char refused[] = "The board refused a firmware update request.";

class Channel : public ControlChannel {
 public:
  explicit Channel(std::uint8_t interface_number) : interface_(interface_number) {}

  std::vector<std::byte> read(const UpdateRequest& request, std::uint16_t length) override {
    return read_control({class_in, request.request, request.value, interface_, length});
  }
  void write(const UpdateRequest& request, std::span<const std::byte> data) override {
    write_control({class_out, request.request, request.value, interface_, static_cast<std::uint16_t>(data.size())},
                  data);
  }
  void select_alternate(std::uint8_t alternate) override {
    write_control({interface_out, set_interface, alternate, interface_, 0}, {});
  }
  std::string alternate_name(std::uint8_t alternate) override {
    using setup::DescriptorType;
    const auto configuration = read_control(setup::get_descriptor(DescriptorType::configuration, 0, 1024));
    const auto index = name_of_alternate(configuration, interface_, alternate);
    return index == 0 ? std::string()
                      : parse_string(read_control(setup::get_descriptor(DescriptorType::string, index, 255)));
  }

 protected:
  virtual std::vector<std::byte> read_control(const Setup& setup) = 0;
  virtual void write_control(const Setup& setup, std::span<const std::byte> data) = 0;

 private:
  std::uint8_t interface_;
};

class UsbChannel final : public Channel {
 public:
  UsbChannel(std::uint16_t vendor_id, std::uint16_t product_id, const std::string& serial_number,
             std::uint8_t interface_number)
      : Channel(interface_number), handle_(vendor_id, product_id, serial_number) {
    handle_.claim(interface_number, in_use);
  }

 private:
  std::vector<std::byte> read_control(const Setup& setup) override {
    std::vector<std::byte> data(setup.length);
    data.resize(transfer(setup, data.data()));
    return data;
  }
  void write_control(const Setup& setup, std::span<const std::byte> data) override {
    std::vector<std::byte> copy(data.begin(), data.end());  // libusb requires a non-const pointer
    transfer(setup, copy.data());
  }
  std::size_t transfer(const Setup& setup, std::byte* data) {
    const int length =
        libusb_control_transfer(handle_.get(), setup.request_type, setup.request, setup.value, setup.index,
                                reinterpret_cast<unsigned char*>(data), setup.length, timeout_ms);
    if (length == LIBUSB_ERROR_PIPE) throw Stalled(refused);
    if (length == LIBUSB_ERROR_TIMEOUT)
      throw Error("The board does not answer. Unplug its cable and plug the cable in again.");
    if (length < 0) throw Disconnected(unplugged);
    return static_cast<std::size_t>(length);
  }

  UsbHandle handle_;
};

class UsbipChannel final : public Channel {
 public:
  UsbipChannel(const Endpoint& endpoint, std::uint8_t interface_number)
      : Channel(interface_number), connection_(endpoint.server, endpoint.path, std::chrono::milliseconds(timeout_ms)) {
    connection_.start([](const std::string&) {});
    const auto descriptor =
        connection_.control_in(setup::get_descriptor(setup::DescriptorType::configuration, 0, 1024));
    constexpr std::size_t value_at = 5;
    if (descriptor.size() <= value_at) throw Error("The device's USB configuration is damaged. Reset the board.");
    connection_.control_out(setup::set_configuration(std::to_integer<std::uint8_t>(descriptor[value_at])), {});
  }
  ~UsbipChannel() override { connection_.close(); }

 private:
  std::vector<std::byte> read_control(const Setup& setup) override {
    try {
      return connection_.control_in(setup);
    } catch (const Stalled&) {
      throw Stalled(refused);
    }
  }
  void write_control(const Setup& setup, std::span<const std::byte> data) override {
    try {
      connection_.control_out(setup, data);
    } catch (const Stalled&) {
      throw Stalled(refused);
    }
  }

  UsbipConnection connection_;
};

}  // namespace

std::vector<Endpoint> find_boot_loaders(const Address& address) {
  std::vector<Endpoint> endpoints;
  if (address.kind == Address::Kind::usbip) {
    for (const auto& device : list_usbip_devices(address.server))
      if (device.vendor_id == identity::boot_loader_vendor_id && device.product_id == identity::boot_loader_product_id)
        endpoints.push_back({Endpoint::Kind::usbip, "", identity::boot_loader_product, device.bus_id, address.server});
  } else if (address.kind == Address::Kind::usb) {
    for (const auto& number : usb_serial_numbers(identity::boot_loader_vendor_id, identity::boot_loader_product_id))
      endpoints.push_back({Endpoint::Kind::usb, number, identity::boot_loader_product, "", {}});
  }
  return endpoints;
}

std::unique_ptr<ControlChannel> open_boot_loader(const Endpoint& endpoint) {
  if (endpoint.kind == Endpoint::Kind::usbip) return std::make_unique<UsbipChannel>(endpoint, boot_loader_interface);
  return std::make_unique<UsbChannel>(identity::boot_loader_vendor_id, identity::boot_loader_product_id,
                                      endpoint.serial_number, boot_loader_interface);
}

namespace {

/// Returns true if the firmware reports that the force prevents the detach. Returns false without an answer.
bool has_refused(ControlChannel& channel) {
  try {
    const auto status = channel.read({get_status_request}, status_length);
    return !status.empty() && std::to_integer<std::uint8_t>(status[0]) == status_vendor_error;
  } catch (const Error&) {
    return false;
  }
}

void detach(ControlChannel& channel) {
  constexpr std::uint16_t within_ms = 1000;
  channel.write({detach_request, within_ms}, {});  // firmware with protocol 15 refuses this request with a stall
  if (has_refused(channel)) throw Stalled(refused);
}

}  // namespace

void detach_firmware(const Endpoint& endpoint) {
  if (endpoint.kind == Endpoint::Kind::usbip) {
    UsbipChannel channel(endpoint, identity::firmware_update_interface);
    detach(channel);
  } else {
    UsbChannel channel(identity::vendor_id, identity::product_id, endpoint.serial_number,
                       identity::firmware_update_interface);
    detach(channel);
  }
}

}  // namespace inkwell::device
