// The standard requests (USB 2.0, section 9.4).
#include <cstring>
#include <string_view>

#include "firmware/usb/device.hpp"
#include "protocol/usb_identity.hpp"

#include "firmware/usb/descriptors.hpp"

namespace inkwell::usb {

namespace {

enum Request : std::uint8_t {
  get_status_request = 0,
  clear_feature_request = 1,
  set_feature_request = 3,
  set_address_request = 5,
  get_descriptor_request = 6,
  get_configuration_request = 8,
  set_configuration_request = 9,
  get_interface_request = 10,
  set_interface_request = 11,
};

enum Recipient : std::uint8_t { device_recipient = 0, interface_recipient = 1, endpoint_recipient = 2 };

constexpr std::uint16_t endpoint_halt_feature = 0;
constexpr std::uint16_t english = 0x0409;
constexpr std::byte self_powered_status{1};

}  // namespace

Answer Device::request(const SetupPacket& setup) {
  switch (setup.request_type & 0x60u) {
    case 0x00: return standard_request(setup);
    case 0x20: return class_request(setup);
    case 0x40: return vendor_request(setup);
    default: return Answer::stall();
  }
}

Answer Device::standard_request(const SetupPacket& setup) {
  const auto recipient = static_cast<Recipient>(setup.request_type & 0x1Fu);
  const bool to_host = setup.device_to_host();
  // Refuses requests with a wrong direction or wLength.
  const auto is = [&](Request request, bool direction_to_host) {
    return setup.request == request && to_host == direction_to_host && (direction_to_host || setup.length == 0);
  };

  if (is(get_status_request, true)) return get_status(setup);
  if (is(get_descriptor_request, true) && recipient != endpoint_recipient) return get_descriptor(setup);
  if (recipient == endpoint_recipient && setup.value == endpoint_halt_feature) {
    if (is(clear_feature_request, false)) return change_halt(setup, false);
    if (is(set_feature_request, false)) return change_halt(setup, true);
  }
  if (recipient == device_recipient) {
    if (is(set_address_request, false)) {
      if (setup.value > 127 || setup.index != 0) return Answer::stall();
      port_.set_address(setup.value_low());
      return Answer::done();
    }
    if (is(get_configuration_request, true)) return send_byte(configuration_);
    if (is(set_configuration_request, false)) return set_configuration(setup);
  }
  if (recipient == interface_recipient && configured() && setup.index < protocol::usb::interface_count &&
      setup.value == 0) {
    if (is(get_interface_request, true)) return send_byte(0);
    if (is(set_interface_request, false)) {
      // The interface has only one setting. The endpoints of the interface restart (USB 2.0, section 9.1.1.5).
      for (Endpoint& endpoint : endpoints_)
        if (endpoint.interface_number == setup.index) restart(endpoint);
      return Answer::done();
    }
  }
  return Answer::stall();
}

Answer Device::send_byte(std::uint8_t value) {
  control_.buffer()[0] = static_cast<std::byte>(value);
  return Answer::send(control_.buffer().first(1));
}

Answer Device::get_status(const SetupPacket& setup) {
  const auto status = control_.buffer().first<2>();
  status[0] = status[1] = std::byte{0};
  if (setup.value != 0) return Answer::stall();
  switch (setup.request_type & 0x1Fu) {
    case device_recipient:
      status[0] = self_powered_status;
      return setup.index == 0 ? Answer::send(status) : Answer::stall();
    case interface_recipient:
      return configured() && setup.index < protocol::usb::interface_count ? Answer::send(status) : Answer::stall();
    case endpoint_recipient: {
      if ((setup.index & 0xFF7Fu) == 0) return Answer::send(status);  // endpoint 0 in either direction
      const Endpoint* endpoint = find_endpoint(setup.index);
      if (endpoint == nullptr) return Answer::stall();
      status[0] = static_cast<std::byte>(endpoint->halted);
      return Answer::send(status);
    }
    default: return Answer::stall();
  }
}

Answer Device::change_halt(const SetupPacket& setup, bool halted) {
  if ((setup.index & 0xFF7Fu) == 0) return Answer::done();  // endpoint 0 has no persistent halt
  Endpoint* endpoint = find_endpoint(setup.index);
  if (endpoint == nullptr) return Answer::stall();
  if (halted) {
    port_.stall(endpoint->address);
    endpoint->halted = true;
  } else {
    restart(*endpoint);
  }
  return Answer::done();
}

Answer Device::set_configuration(const SetupPacket& setup) {
  if (setup.index != 0) return Answer::stall();
  if (setup.value == configuration_value) {
    configuration_ = configuration_value;
    start_endpoints();
    return Answer::done();
  }
  if (setup.value == 0) {
    stop_endpoints();
    configuration_ = 0;
    host_gone();
    return Answer::done();
  }
  return Answer::stall();
}

Answer Device::get_descriptor(const SetupPacket& setup) {
  const auto type = static_cast<DescriptorType>(setup.value_high());
  const std::uint8_t index = setup.value_low();
  if ((setup.request_type & 0x1Fu) == interface_recipient) {
    if (setup.index >= protocol::usb::interface_count || index != 0) return Answer::stall();
    const auto interface_number = static_cast<std::uint8_t>(setup.index);
    std::span<const std::byte> descriptor;
    if (type == DescriptorType::hid) descriptor = hid_descriptor(interface_number);
    if (type == DescriptorType::hid_report) descriptor = hid_report_descriptor(interface_number);
    return descriptor.empty() ? Answer::stall() : Answer::send(descriptor);
  }
  if (type == DescriptorType::string) return string_descriptor(index);
  if (index != 0) return Answer::stall();
  switch (type) {
    case DescriptorType::device: return Answer::send(device_descriptor(control_.buffer(), identity_.firmware_version));
    case DescriptorType::configuration: return Answer::send(configuration_descriptor());
    case DescriptorType::binary_object_store: return Answer::send(binary_object_store());
    default: return Answer::stall();  // also for a device qualifier, because the device does not support high speed
  }
}

Answer Device::string_descriptor(std::uint8_t index) {
  std::string_view text;
  const auto descriptor = control_.buffer();
  switch (static_cast<StringIndex>(index)) {
    case StringIndex::languages:
      descriptor[0] = std::byte{4};
      descriptor[1] = static_cast<std::byte>(DescriptorType::string);
      std::memcpy(&descriptor[2], &english, sizeof english);
      return Answer::send(descriptor.first(4));
    case StringIndex::manufacturer: text = protocol::usb::manufacturer; break;
    case StringIndex::product: text = protocol::usb::product; break;
    case StringIndex::serial_number: text = {identity_.serial_number.data(), identity_.serial_number.size()}; break;
    case StringIndex::hid: text = "Pose, commands and parameters"; break;
    case StringIndex::scope: text = "Scope"; break;
    case StringIndex::controller: text = "Six axes and two buttons"; break;
    case StringIndex::firmware_update: text = "Firmware update"; break;
    default: return Answer::stall();
  }
  const std::size_t size = 2 + 2 * text.size();
  descriptor[0] = static_cast<std::byte>(size);
  descriptor[1] = static_cast<std::byte>(DescriptorType::string);
  for (std::size_t i = 0; i < text.size(); ++i) {  // ASCII to UTF-16
    descriptor[2 + 2 * i] = static_cast<std::byte>(text[i]);
    descriptor[3 + 2 * i] = std::byte{0};
  }
  return Answer::send(descriptor.first(size));
}

}  // namespace inkwell::usb
