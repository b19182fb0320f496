// What the console says first.
#pragma once

#include <drivers/system.hpp>
#include <optional>
#include <protocol/black_box.hpp>

namespace inkwell::application {

/// Starts the console and writes version, cause of the reset, and, if there was one, where the crash was.
void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash);

/// Says on the console, at the clock that runs without the crystal, why there is no USB.
void report_no_crystal();

}  // namespace inkwell::application
