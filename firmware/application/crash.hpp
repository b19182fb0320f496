// What is known of a crash, from the fault handler over the reset to the start that tells of it.
#pragma once

#include <drivers/kept_over_reset.hpp>
#include <protocol/black_box.hpp>

namespace inkwell::application {

extern drivers::KeptOverReset<protocol::CrashFacts> crash_record;

/// Nothing else raises the non-maskable interrupt (RM0090, "Clock security system").
constexpr bool crystal_stopped(const protocol::CrashFacts& crash) {
  return crash.exception == protocol::crystal_exception;
}

/// Left by a main loop that hung; void if that came back, or if something else than the watchdog ended it.
constexpr bool is_hang(const protocol::CrashFacts& crash) { return crash.exception == protocol::hang_exception; }

}  // namespace inkwell::application
