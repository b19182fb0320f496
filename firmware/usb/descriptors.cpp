#include "firmware/usb/descriptors.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "firmware/usb/port.hpp"
#include "protocol/report_table.hpp"
#include "protocol/usb_identity.hpp"

namespace inkwell::usb {

namespace {

namespace identity = protocol::usb;

// ---- building blocks -----------------------------------------------------------------------------

template <std::size_t... sizes>
constexpr auto join(const std::array<std::uint8_t, sizes>&... parts) {
  std::array<std::uint8_t, (sizes + ...)> whole{};
  std::size_t at = 0;
  const auto append = [&](const auto& part) {
    for (const std::uint8_t byte : part) whole[at++] = byte;
  };
  (append(parts), ...);
  return whole;
}

template <class... Numbers>
constexpr std::array<std::uint8_t, sizeof...(Numbers)> bytes(Numbers... numbers) {
  return {static_cast<std::uint8_t>(numbers)...};
}

constexpr std::uint8_t low(std::size_t number) { return static_cast<std::uint8_t>(number); }
constexpr std::uint8_t high(std::size_t number) { return static_cast<std::uint8_t>(number >> 8); }

/// Text as UTF-16, followed by `zeros` zero characters.
template <std::size_t zeros, std::size_t size>
constexpr auto utf16(const char (&text)[size]) {
  std::array<std::uint8_t, 2 * (size - 1 + zeros)> wide{};
  for (std::size_t i = 0; i + 1 < size; ++i) wide[2 * i] = static_cast<std::uint8_t>(text[i]);
  return wide;
}

constexpr std::uint8_t type(DescriptorType type) { return static_cast<std::uint8_t>(type); }
constexpr std::uint8_t string(StringIndex index) { return static_cast<std::uint8_t>(index); }

// ---- HID report descriptor (HID 1.11, section 6.2.2) -----------------------------------------------

// Every report is an array of bytes on a vendor usage page. The header protocol/reports.hpp defines the meaning of the
// bytes.

constexpr std::uint8_t input_item = 0x81, output_item = 0x91, feature_item = 0xB1;
constexpr std::uint8_t data_variable_absolute = 0x02;

constexpr std::uint8_t item_of(protocol::ReportKind kind) {
  switch (kind) {
    case protocol::ReportKind::input: return input_item;
    case protocol::ReportKind::output: return output_item;
    case protocol::ReportKind::feature: return feature_item;
  }
  return 0;
}

/// HID items of one report: report id and report bytes.
constexpr auto items_of(const protocol::ReportInfo& row) {
  const std::size_t count = row.bytes - 1;
  return bytes(0x85, static_cast<std::uint8_t>(row.id),  // report id
               0x09, row.usage,                          // usage
               0x96, low(count), high(count),            // report count, 16 bits
               item_of(row.kind), data_variable_absolute);
}

constexpr auto reports = []() {
  constexpr std::size_t items_size = items_of(protocol::report_table[0]).size();
  std::array<std::uint8_t, protocol::report_table.size() * items_size> items{};
  for (std::size_t i = 0; i < protocol::report_table.size(); ++i)
    std::ranges::copy(items_of(protocol::report_table[i]), items.begin() + i * items_size);
  return items;
}();

constexpr auto report_descriptor = join(bytes(0x06, 0x00, 0xFF,  // usage page: vendor
                                              0x09, 0x01,        // usage
                                              0xA1, 0x01,        // application collection
                                              0x15, 0x00,        // logical minimum 0
                                              0x26, 0xFF, 0x00,  // logical maximum 255
                                              0x75, 0x08),       // report size, 8 bits
                                        reports,
                                        bytes(0xC0));  // end of the collection

// ---- HID report descriptor of the controller (HID usage tables 1.12, section 4) -----------------------

/// Three axes of 16 bits. One step of an axis is `unit` times ten to the power of `exponent`.
constexpr auto three_axes(std::uint8_t first_usage, std::uint8_t unit, std::uint8_t exponent) {
  return bytes(0x65, unit, 0x55, exponent & 0x0F,                                //
               0x09, first_usage, 0x09, first_usage + 1, 0x09, first_usage + 2,  // usages
               0x75, 16, 0x95, 3, input_item, data_variable_absolute);
}

constexpr std::uint8_t usage_x = 0x30, usage_rx = 0x33;
constexpr std::uint8_t centimetre = 0x11, radian = 0x12;
// Unit exponents of the axes. The descriptor uses centimeters, and the protocol uses meters.
constexpr std::uint8_t thousandths = 0xFD, ten_thousandths = 0xFC;
static_assert(protocol::controller_position_step_m == 1e-5f && protocol::controller_angle_step_rad == 1e-4f);

constexpr auto controller_report_descriptor = join(
    bytes(0x05, 0x01,                           // usage page: generic desktop
          0x09, 0x08,                           // usage: multi-axis controller
          0xA1, 0x01,                           // application collection
          0x16, 0x01, 0x80, 0x26, 0xFF, 0x7F,   // logical range -32767 to 32767
          0x36, 0x01, 0x80, 0x46, 0xFF, 0x7F),  // same physical range
    three_axes(usage_x, centimetre, thousandths), three_axes(usage_rx, radian, ten_thousandths),
    bytes(0x65, 0, 0x55, 0, 0x35, 0, 0x45, 0,  // no unit
          0x05, 0x09, 0x19, 1, 0x29, 2,        // usage page: buttons 1 and 2
          0x15, 0, 0x25, 1,                    // logical range 0 to 1
          0x75, 1, 0x95, 2, input_item, data_variable_absolute, 0x95, 14, input_item, 0x03,  // constant: fills the word
          0xC0));

// ---- device and configuration (USB 2.0, section 9.6) -----------------------------------------------

/// USB version 2.01 announces a binary object store.
constexpr std::size_t usb_version = 0x0201;
/// Position of bcdDevice in the device descriptor. The function device_descriptor() writes the firmware version to
/// bcdDevice.
constexpr std::size_t device_version_at = 12;

constexpr auto device =
    bytes(18, type(DescriptorType::device), low(usb_version), high(usb_version), 0, 0,
          0,  // class, subclass and protocol are in the interfaces
          packet_size_maximum, low(identity::vendor_id), high(identity::vendor_id), low(identity::product_id),
          high(identity::product_id), 0, 0, string(StringIndex::manufacturer), string(StringIndex::product),
          string(StringIndex::serial_number), 1);

constexpr auto hid_with(std::size_t report_descriptor_size) {
  return bytes(9, type(DescriptorType::hid), 0x11, 0x01,  // HID 1.11
               0, 1,                                      // no country code; one descriptor follows
               type(DescriptorType::hid_report), low(report_descriptor_size), high(report_descriptor_size));
}
constexpr auto hid = hid_with(report_descriptor.size());
constexpr auto controller_hid = hid_with(controller_report_descriptor.size());

constexpr auto interface(std::uint8_t number, std::uint8_t endpoints, std::uint8_t class_code, StringIndex name,
                         std::uint8_t subclass = 0, std::uint8_t protocol = 0) {
  return bytes(9, type(DescriptorType::interface), number, 0, endpoints, class_code, subclass, protocol, string(name));
}

constexpr auto endpoint(std::uint8_t address, EndpointType endpoint_type, std::uint8_t interval_ms) {
  return bytes(7, type(DescriptorType::endpoint), address, static_cast<std::uint8_t>(endpoint_type),
               low(identity::packet_size), high(identity::packet_size), interval_ms);
}

constexpr std::uint8_t hid_class = 0x03, application_class = 0xFE, vendor_class = 0xFF;
constexpr std::uint8_t firmware_update_subclass = 1, run_time_protocol = 1;

/// DFU 1.1, section 4.1.3. The board detaches from the bus without a bus reset. After the detach, the boot loader
/// reports its transfer size.
constexpr auto firmware_update = []() {
  constexpr std::uint8_t can_download = 1, can_upload = 2, will_detach = 8;
  constexpr std::size_t detach_timeout_ms = 255, transfer_size = 2048;
  return bytes(9, type(DescriptorType::firmware_update), can_download | can_upload | will_detach,
               low(detach_timeout_ms), high(detach_timeout_ms), low(transfer_size), high(transfer_size), 0x10,
               0x01);  // DFU 1.1
}();

constexpr auto interfaces =
    join(interface(identity::hid_interface, 2, hid_class, StringIndex::hid), hid,
         endpoint(identity::hid_in_endpoint, EndpointType::interrupt, 1),
         endpoint(identity::hid_out_endpoint, EndpointType::interrupt, 1),
         interface(identity::scope_interface, 1, vendor_class, StringIndex::scope),
         endpoint(identity::scope_in_endpoint, EndpointType::bulk, 0),
         interface(identity::controller_interface, 1, hid_class, StringIndex::controller), controller_hid,
         endpoint(identity::controller_in_endpoint, EndpointType::interrupt, identity::controller_interval_ms),
         interface(identity::firmware_update_interface, 0, application_class, StringIndex::firmware_update,
                   firmware_update_subclass, run_time_protocol),
         firmware_update);

constexpr std::size_t configuration_size = 9 + interfaces.size();
constexpr std::uint8_t self_powered = 0xC0;
constexpr std::uint8_t bus_current_2mA = 0;  ///< 0, because board and logic have a separate supply

constexpr auto configuration =
    join(bytes(9, type(DescriptorType::configuration), low(configuration_size), high(configuration_size),
               identity::interface_count, configuration_value, 0, self_powered, bus_current_2mA),
         interfaces);

// ---- Microsoft OS 2.0 descriptors -------------------------------------------------------------------

// Windows binds WinUSB to all interfaces except the HID interfaces.

constexpr auto windows_8_1 = bytes(0x00, 0x00, 0x03, 0x06);

constexpr auto property_name = utf16<1>("DeviceInterfaceGUIDs");

/// Programs find an interface by its DeviceInterfaceGUIDs property. Each interface needs a different GUID.
template <std::size_t size>
constexpr auto interface_guid(const char (&guid)[size]) {
  constexpr std::size_t value_size = 2 * (size - 1 + 2);
  constexpr std::size_t property_size = 10 + property_name.size() + value_size;
  constexpr std::uint8_t multiple_strings = 7;
  return join(bytes(low(property_size), high(property_size), 4, 0, multiple_strings, 0, low(property_name.size()), 0),
              property_name, bytes(low(value_size), 0), utf16<2>(guid));
}

constexpr auto compatible_id = bytes(20, 0, 3, 0, 'W', 'I', 'N', 'U', 'S', 'B', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);

template <std::size_t size>
constexpr auto win_usb_function(std::uint8_t first_interface, const char (&guid)[size]) {
  const auto property = interface_guid(guid);
  const std::size_t function_size = 8 + compatible_id.size() + property.size();
  return join(bytes(8, 0, 2, 0, first_interface, 0, low(function_size), high(function_size)), compatible_id, property);
}

constexpr auto microsoft_set = []() {
  constexpr auto functions =
      join(win_usb_function(identity::scope_interface, "{5A1E7D6B-3C0F-4E59-9B7C-0D2B6C1F8A44}"),
           win_usb_function(identity::firmware_update_interface, "{EC396C1F-BD53-4F5A-A880-E944C0308F12}"));
  constexpr std::size_t subset_size = 8 + functions.size();
  constexpr std::size_t size = 10 + subset_size;
  return join(bytes(10, 0, 0, 0), windows_8_1, bytes(low(size), high(size)),
              bytes(8, 0, 1, 0, 0, 0, low(subset_size), high(subset_size)),  // first configuration
              functions);
}();

// ---- Binary object store (USB 2.0 ECN "Link Power Management", USB 3.2 section 9.6.2) ------------------

/// The USB 2.0 extension capability is mandatory for a device with USB version 2.01. No attribute is set, because the
/// device does not support link power management.
constexpr auto usb_2_0_extension = bytes(7, type(DescriptorType::device_capability), 2, 0, 0, 0, 0);

/// Platform capability with the UUID of the Microsoft OS 2.0 descriptors.
constexpr auto microsoft_capability = []() {
  constexpr std::uint8_t capability_size = 28, platform = 5;
  return join(bytes(capability_size, type(DescriptorType::device_capability), platform, 0),
              bytes(0xDF, 0x60, 0xDD, 0xD8, 0x89, 0x45, 0xC7, 0x4C, 0x9C, 0xD2, 0x65, 0x9D, 0x9E, 0x64, 0x8A, 0x9F),
              windows_8_1, bytes(low(microsoft_set.size()), high(microsoft_set.size()), microsoft_request, 0));
}();

constexpr auto object_store = []() {
  constexpr std::size_t size = 5 + usb_2_0_extension.size() + microsoft_capability.size();
  constexpr std::uint8_t capability_count = 2;
  return join(bytes(5, type(DescriptorType::binary_object_store), low(size), high(size), capability_count),
              usb_2_0_extension, microsoft_capability);
}();

}  // namespace

std::span<const std::byte> device_descriptor(std::span<std::byte> buffer,
                                             const std::array<std::uint8_t, 3>& firmware_version) {
  const auto digit = [](std::uint8_t number) { return std::min<unsigned>(number, 9); };
  const auto [major, minor, patch] = firmware_version;
  std::ranges::copy(std::as_bytes(std::span(device)), buffer.begin());
  buffer[device_version_at] = static_cast<std::byte>(digit(minor) << 4 | digit(patch));
  buffer[device_version_at + 1] = static_cast<std::byte>(major / 10 << 4 | major % 10);
  return buffer.first(device.size());
}
std::span<const std::byte> configuration_descriptor() { return std::as_bytes(std::span(configuration)); }
std::span<const std::byte> binary_object_store() { return std::as_bytes(std::span(object_store)); }
std::span<const std::byte> hid_descriptor(std::uint8_t interface_number) {
  switch (interface_number) {
    case identity::hid_interface: return std::as_bytes(std::span(hid));
    case identity::controller_interface: return std::as_bytes(std::span(controller_hid));
    default: return {};
  }
}
std::span<const std::byte> hid_report_descriptor(std::uint8_t interface_number) {
  switch (interface_number) {
    case identity::hid_interface: return std::as_bytes(std::span(report_descriptor));
    case identity::controller_interface: return std::as_bytes(std::span(controller_report_descriptor));
    default: return {};
  }
}
std::span<const std::byte> microsoft_descriptor_set() { return std::as_bytes(std::span(microsoft_set)); }

}  // namespace inkwell::usb
