// Functions for the fault search, the input fields and the texts of the faults pane.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/device/session.hpp"
#include "protocol/injection_request.hpp"

namespace inkwell::window {

/// Returns the reason and the remedy if no fault can be injected.
std::string_view obstacle(const device::SessionStatus& status, bool knows_control_port);

/// Returns a title such as "Bridge legs".
std::string_view title_of(protocol::InjectionPart part);

/// Returns a name in words, such as "Wire open" for "wire_open".
std::string readable_name(std::string_view name);

/// Returns true if each word of the search occurs in the fault's name, part or help. The search ignores case. An empty
/// search matches every fault.
bool is_found(const protocol::InjectionInfo& row, std::string_view search);

/// Returns the names of all wires for fault injection.
std::vector<std::string_view> wires();

/// Contents of the input fields. An empty input field selects the board's default.
struct TypedInjection {
  protocol::InjectedFault fault;
  std::string of, amount, after_s, for_s;
};

/// Replaces the name of a fault at the start of a refusal by words.
std::string with_readable_name(std::string_view sentence);

/// Returns the missing field of an incomplete input, such as "Choose a wire."; empty if the input is complete.
std::string_view missing_input(const TypedInjection& typed);

/// Converts the fields to a request. Throws device::Error if a field is not a number.
protocol::InjectionRequest request_of(const TypedInjection& typed);

/// Returns a text such as "motor 2, 0.01"; empty if the fault has neither location nor amount.
std::string location_and_amount(const device::Injection& injection);

/// Returns a text such as "0.05 ms", "12.4 ms" or "1.35 s".
std::string duration_text(double duration_s);

}  // namespace inkwell::window
