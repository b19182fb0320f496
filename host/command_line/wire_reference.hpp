// What goes over the wire, field by field, as the protocol's headers have it.
#pragma once

#include <string_view>

#include <protocol/signals.hpp>

namespace inkwell::command_line {

/// Prints it as Markdown.
void print_wire();
/// How a signal is written into a scope frame, as print_wire() calls it.
std::string_view name_of(protocol::SignalWire wire);

}  // namespace inkwell::command_line
