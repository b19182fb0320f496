// What a virtual board answers on its control socket, made sense of: a line each.
#pragma once

#include <string>
#include <string_view>

#include <device/control_client.hpp>

namespace inkwell::device {

/// The answer to a command. Throws CommandRefused if the board refuses it, Error if the line is no board's.
nlohmann::json parse_answer(std::string_view line, std::string_view command);

// What is in an answer. What it leaves out is nothing, but for a trace and for the faults that are in. All throw Error
// if it holds something else than it should.
BoardStatus status_of(nlohmann::json answer);
PinLevels pin_levels_of(const nlohmann::json& answer);
PutInFault put_in_fault_of(const nlohmann::json& answer, const protocol::InjectionRequest& asked);
Injections injections_of(const nlohmann::json& status);
MeterReading meter_reading_of(const nlohmann::json& answer);
Trace trace_of(const nlohmann::json& answer);

}  // namespace inkwell::device
