// First output of the console.
#pragma once

#include <drivers/system.hpp>
#include <optional>
#include <protocol/black_box.hpp>

namespace inkwell::application {

/// Starts the console and writes the version, the reset cause and, after a crash, its location.
void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash);

/// Reports on the console why there is no USB. The console then runs from the internal oscillator.
void report_no_crystal();

}  // namespace inkwell::application
