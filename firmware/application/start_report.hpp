// First console output of each boot.
#pragma once

#include <optional>
#include "firmware/drivers/system.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::application {

/// Starts the console and writes the version, the reset cause and, after a crash, the crash location.
void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash);

/// Reports on the console why USB is not available. The console then uses the internal oscillator.
void report_no_crystal();

}  // namespace inkwell::application
