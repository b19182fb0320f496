// Prints the wire structures of the protocol headers.
#pragma once

#include <string_view>

#include "protocol/signals.hpp"

namespace inkwell::command_line {

/// Prints the layout as Markdown.
void print_wire();
/// Returns the name that print_wire() prints for a signal encoding.
std::string_view name_of(protocol::SignalWire wire);

}  // namespace inkwell::command_line
