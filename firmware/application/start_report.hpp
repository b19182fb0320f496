// First console output of each boot.
#pragma once

#include <optional>
#include "firmware/drivers/system.hpp"
#include "protocol/black_box.hpp"

namespace inkwell::application {

/// Starts the console and writes the version, the reset cause and the location of a crash.
void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash);

/// Reports on the console why USB is not available. In this case the console runs from the internal oscillator.
void report_no_crystal();

}  // namespace inkwell::application
