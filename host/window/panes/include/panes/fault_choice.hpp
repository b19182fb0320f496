// What a user types to find a fault of the table and to put it into the virtual board, and how faults are told.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <device/control_client.hpp>
#include <device/session.hpp>
#include <protocol/injection_request.hpp>

namespace inkwell::window {

/// Why no fault can be put in, and what to do; empty if one can.
std::string_view obstacle(const device::SessionStatus& status, bool knows_control_port);

/// "Bridge legs"
std::string_view title_of(protocol::InjectionPart part);

/// Whether each word of the search stands somewhere in the fault's name, part or help, in small or capital letters. An
/// empty search finds everything.
bool is_found(const protocol::InjectionInfo& row, std::string_view search);

/// The wires that faults can be put into, as the board's facts call them.
std::vector<std::string_view> wires();

/// As it stands in the fields; what is empty was not said.
struct TypedFault {
  protocol::InjectedFault fault;
  std::string of, amount, after_s, for_s;
};

/// What the board is asked for. Throws device::Error with a sentence if a field holds no number; all else is for the
/// board to judge.
protocol::InjectionRequest request_of(const TypedFault& typed);

/// "motor 2, 0.01", "encoders[1].a"; empty where there is nothing to say.
std::string place_and_amount(const device::PutInFault& put_in);

/// "0.05 ms", "12.4 ms", "1.35 s"
std::string duration_text(double duration_s);

}  // namespace inkwell::window
