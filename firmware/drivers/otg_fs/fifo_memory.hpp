// Layout and flush functions of the FIFO memory (RM0090, "Peripheral FIFO architecture").
//
//   Words   0 to  55   Receive FIFO.
//   Words  56 to  71   Endpoint 0 IN, one packet of 64 bytes.
//   Words  72 to  87   Endpoint 1 IN, HID, one report.
//   Words  88 to 215   Endpoint 2 IN, scope, eight packets.
//   Words 216 to 231   Endpoint 3 IN, controller, one report.
//   Words 232 to 319   Unused.
//
// The receive FIFO has 13 words for SETUP packets (4 for each of three packets, 1 for control) and 1 word for global
// NAK. Two packets of 64 bytes with their status need 2 x 17 words. The completed transfers of two OUT endpoints need
// 2 x 4 words.
//
// The eight scope packets last 0.4 ms on the bus. The core has a three-bit packet counter and would not count a ninth
// packet.
#pragma once

#include <cstdint>

#include "firmware/usb/port.hpp"

namespace inkwell::drivers::fifo_memory {

inline constexpr std::uint32_t memory_words = 320;
inline constexpr std::uint32_t receive_words = 13 + 1 + 2 * 17 + 2 * 4;
inline constexpr std::uint32_t control_words = 16;
inline constexpr std::uint32_t hid_words = 16;
inline constexpr std::uint32_t control_start = receive_words;
inline constexpr std::uint32_t hid_start = control_start + control_words;
inline constexpr std::uint32_t scope_start = hid_start + hid_words;
/// Largest number of packets in a FIFO (RM0090, section 34.17.6). Only the last packet of a transfer may be short. A
/// transfer starts after the previous transfer has left the FIFO.
inline constexpr std::uint32_t packets_in_fifo_maximum = 8;
inline constexpr std::uint32_t packet_words = usb::packet_size_maximum / 4;
inline constexpr std::uint32_t scope_words = packets_in_fifo_maximum * packet_words;
inline constexpr std::uint32_t controller_start = scope_start + scope_words;
inline constexpr std::uint32_t controller_words = 16;  ///< smallest allowed size
static_assert(control_words == packet_words && hid_words == packet_words);
static_assert(scope_words / packet_words <= packets_in_fifo_maximum, "the core's count of packets would wrap");
static_assert(controller_start + controller_words <= memory_words);

/// TXFNUM value for all transmit FIFOs.
inline constexpr std::uint32_t all_transmit_fifos = 0x10;

void lay_out();
void flush_transmit(std::uint32_t number);
void flush_receive();

}  // namespace inkwell::drivers::fifo_memory
