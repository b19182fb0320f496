// USB identity of the device: identifiers, interfaces and endpoints.
#pragma once

#include <cstdint>

namespace inkwell::protocol::usb {

/// Vendor identifier of pid.codes, and the product identifier for private tests. The page docs/flashing.md describes
/// how to register a product identifier.
inline constexpr std::uint16_t vendor_id = 0x1209;
inline constexpr std::uint16_t product_id = 0x0001;
inline constexpr bool is_test_identity = true;
inline constexpr char manufacturer[] = "Inkwell";
inline constexpr char product[] = "Inkwell haptic arm";

inline constexpr std::uint8_t hid_interface = 0;
inline constexpr std::uint8_t hid_in_endpoint = 0x81;   ///< interrupt, 64 bytes, 1 ms
inline constexpr std::uint8_t hid_out_endpoint = 0x01;  ///< interrupt, 64 bytes, 1 ms
inline constexpr std::uint8_t scope_interface = 1;
inline constexpr std::uint8_t scope_in_endpoint = 0x82;  ///< bulk, 64 bytes

/// Multi-axis controller for programs that support joysticks. The controller has a separate interface, because two
/// collections of one interface would share an endpoint. With a shared endpoint, the device would lose poses.
inline constexpr std::uint8_t controller_interface = 2;
inline constexpr std::uint8_t controller_in_endpoint = 0x83;  ///< interrupt, 64 bytes
inline constexpr std::uint8_t controller_interval_ms = 8;

/// Run-time interface of USB device firmware upgrade 1.1. DFU_DETACH starts the boot loader in the chip's ROM.
inline constexpr std::uint8_t firmware_update_interface = 3;

/// Identifiers of the boot loader in the chip's ROM. All STM32 chips have the same identifiers (AN2606).
inline constexpr std::uint16_t boot_loader_vendor_id = 0x0483;
inline constexpr std::uint16_t boot_loader_product_id = 0xDF11;
inline constexpr char boot_loader_product[] = "boot loader";

inline constexpr std::uint8_t interface_count = 4;
inline constexpr std::uint16_t packet_size = 64;

}  // namespace inkwell::protocol::usb
