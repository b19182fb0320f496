// Parses the answers on the control socket of a virtual board. Each answer is one line.
#pragma once

#include <string>
#include <string_view>

#include "host/client/device/control_client.hpp"

namespace inkwell::device {

/// Returns the answer to a command. Throws CommandRefused if the board refuses the command, and Error if the line is
/// not an answer of a board.
nlohmann::json parse_answer(std::string_view line, std::string_view command);

// The functions below read the content of an answer. A missing value is zero or empty; a trace and the list of injected
// faults are required. Each function throws Error if a value has the wrong type.
BoardStatus status_of(nlohmann::json answer);
PinLevels pin_levels_of(const nlohmann::json& answer);
Injection injection_of(const nlohmann::json& answer, const protocol::InjectionRequest& request);
Injections injections_of(const nlohmann::json& status);
MeterReading meter_reading_of(const nlohmann::json& answer);
Trace trace_of(const nlohmann::json& answer);

}  // namespace inkwell::device
