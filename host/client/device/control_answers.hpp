// Parses the answers on the control socket of a virtual board.
#pragma once

#include <string>
#include <string_view>

#include "host/client/device/control_client.hpp"

namespace inkwell::device {

/// Parses the answer to a command. Throws CommandRefused if the board refused the command. Throws Error if the line is
/// not a valid answer.
nlohmann::json parse_answer(std::string_view line, std::string_view command);

// These functions read the values in an answer. A missing value becomes zero or empty, but traces and injected faults
// are required. A value of the wrong type throws Error.
BoardStatus status_of(nlohmann::json answer);
PinLevels pin_levels_of(const nlohmann::json& answer);
Injection injection_of(const nlohmann::json& answer, const protocol::InjectionRequest& request);
Injections injections_of(const nlohmann::json& status);
MeterReading meter_reading_of(const nlohmann::json& answer);
Trace trace_of(const nlohmann::json& answer);

}  // namespace inkwell::device
