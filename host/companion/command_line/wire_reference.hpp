// The layout of all wire structures, field by field, from the protocol headers.
#pragma once

#include <string_view>

#include "protocol/signals.hpp"

namespace inkwell::command_line {

/// Prints the layout as Markdown.
void print_wire();
/// Returns the name of a signal encoding, as in the output of print_wire().
std::string_view name_of(protocol::SignalWire wire);

}  // namespace inkwell::command_line
