// Commands below `inkwell parameters` for what the board keeps of them over its power.
#pragma once

#include "commands.hpp"

namespace inkwell::command_line {

void add_store_commands(CLI::App& parameters, const Place& place);

}  // namespace inkwell::command_line
