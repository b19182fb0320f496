// Crash record. The CPU fault handler writes the crash record before the reset, and the next boot reports the record.
#pragma once

#include "firmware/drivers/kept_over_reset.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::application {

extern drivers::KeptOverReset<protocol::CrashFacts> crash_record;

/// Only a stopped crystal raises the non-maskable interrupt (RM0090, "Clock security system").
constexpr bool crystal_stopped(const protocol::CrashFacts& crash) {
  return crash.exception == protocol::crystal_exception;
}

/// Returns true if the crash record describes a hang of the main loop. A hang record is invalid if the main loop
/// resumed, or if the watchdog did not cause the reset.
constexpr bool is_hang(const protocol::CrashFacts& crash) { return crash.exception == protocol::hang_exception; }

}  // namespace inkwell::application
