// The kinds of phases in a soak.
//
// A fault is a false trip unless the kind of the phase lists this fault. The hand exceeds the speed limit only in one
// phase. Wrong dimensions, resistances or gains can trip a fault of a working arm. These parameters change only while
// the force is off, or stay close to the correct values (storm.hpp).
#pragma once

// To add a kind of phase:
// (1) Add a row to INKWELL_SOAK_KINDS with the faults that the board may report in this phase.
// (2) Implement the phase with the functions of Bench and add its case to host/lab/soak/phases.cpp. The compiler
//     reports a missing case. Use only Bench::pass() to advance board time, because this function also checks the
//     board.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "host/lab/soak/random.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::soak {

/// Wrong encoder counts can cause these faults.
inline constexpr protocol::Conditions lost_counts = protocol::condition(protocol::Fault::encoder_implausible) |
                                                    protocol::condition(protocol::Fault::inkwell_implausible);

/// A disconnected host causes one of these faults. The board reports the first detected fault.
inline constexpr protocol::Conditions host_gone =
    protocol::condition(protocol::Fault::usb_gone) | protocol::condition(protocol::Fault::host_silent);

// clang-format off
/// X(name, cards in a deck, faults that may be reported, description)
#define INKWELL_SOAK_KINDS(X) \
  X(docking, 1, {}, "The stylus is put into the inkwell and removed, then the force is switched on.") \
  X(free_space, 1, {}, "The hand wanders through free space, presses buttons, turns the stylus.") \
  X(walls, 2, {}, "The hand presses into walls and slides along them, with up to the force limit.") \
  X(fast, 1, {}, "The hand moves fast, below the speed limit.") \
  X(program, 2, {}, "A program sends forces in every mode and places shapes.") \
  X(scope, 1, {}, "The scope runs and changes its signals.") \
  X(recording, 1, {}, "The scope is recorded into a file, and the file is read.") \
  X(live_storm, 2, {}, "Legal and illegal parameter changes are sent with the force on.") \
  X(wide_storm, 1, lost_counts, \
    "Legal and illegal values of all parameters are sent with the force off, including joint stops and scales.") \
  X(store, 1, {}, "Parameters are stored, restored and erased. The board also restarts, even during a write.") \
  X(cable, 1, host_gone, "The cable is unplugged and plugged in again.") \
  X(silence, 1, protocol::condition(protocol::Fault::host_silent), \
    "The host is silent for shorter and longer than the time-out.") \
  X(killed, 1, host_gone, "The program is killed while the force is on.") \
  X(reset, 1, {}, "The board is reset at any time.") \
  X(too_fast, 1, protocol::condition(protocol::Fault::over_speed), \
    "The hand is faster than a speed limit that was lowered.") \
  X(fault, 4, ~protocol::Conditions(), "A fault from the table is injected and removed.")
// clang-format on

enum class Kind : std::uint8_t {
#define X(name, ...) name,
  INKWELL_SOAK_KINDS(X)
#undef X
};

struct KindInfo {
  std::string_view name;
  unsigned cards;
  protocol::Conditions allowed_faults;
  std::string_view meaning;
};

inline constexpr auto kind_table = std::to_array<KindInfo>({
#define X(name, cards, allowed_faults, meaning) {#name, cards, allowed_faults, meaning},
    INKWELL_SOAK_KINDS(X)
#undef X
});

constexpr const KindInfo& info(Kind kind) { return kind_table[static_cast<std::size_t>(kind)]; }

/// Returns all phases of the table in random order.
std::vector<Kind> shuffled_deck(Random& random);

}  // namespace inkwell::soak
