// Control socket commands for fault injection, and their replies.
#pragma once

#include <nlohmann/json.hpp>

#include "boards/virtual/program/simulation.hpp"

namespace inkwell::virtual_board {

/// injected() lists the active faults, and still_to_come() lists the planned faults.
nlohmann::json injected(Board& board);
nlohmann::json still_to_come(Board& board);
nlohmann::json inject(const nlohmann::json& request, Simulation& simulation);
nlohmann::json heal(const nlohmann::json& request, Simulation& simulation);

}  // namespace inkwell::virtual_board
