// Layout of the 320 words of FIFO memory, and flushing of FIFOs (RM0090, "Peripheral FIFO architecture").
//
//   word   0 +----------------------------------+
//            | receive             56           |  SETUP packets 13 (4 each for three, 1 for control), global
//            |                                  |  NAK 1, two packets of 64 bytes with their status 2 x 17,
//            |                                  |  transfer complete 2 x 4 (two OUT endpoints)
//         56 +----------------------------------+
//            | endpoint 0 IN       16           |  one packet of 64 bytes
//         72 +----------------------------------+
//            | endpoint 1 IN, HID  16           |  one report
//         88 +----------------------------------+
//            | endpoint 2 IN, scope 128         |  8 packets, 0.4 ms of the bus: the core counts the packets in a
//            |                                  |  FIFO with three bits, so it would not count a ninth packet
//        216 +----------------------------------+
//            | endpoint 3 IN       16           |  controller: one report
//        232 +----------------------------------+
//            | not used             88          |
//        320 +----------------------------------+
#pragma once

#include <cstdint>

#include <usb/port.hpp>

namespace inkwell::drivers::fifo_memory {

inline constexpr std::uint32_t memory_words = 320;
inline constexpr std::uint32_t receive_words = 13 + 1 + 2 * 17 + 2 * 4;
inline constexpr std::uint32_t control_words = 16;
inline constexpr std::uint32_t hid_words = 16;
inline constexpr std::uint32_t control_start = receive_words;
inline constexpr std::uint32_t hid_start = control_start + control_words;
inline constexpr std::uint32_t scope_start = hid_start + hid_words;
/// Largest number of packets in a FIFO (RM0090, section 34.17.6). Only the last packet of a transfer may be short, and
/// a transfer starts after the previous transfer has left the FIFO. The bound on words is therefore also a bound on
/// packets.
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
