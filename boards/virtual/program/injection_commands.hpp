// The commands of the control socket that put faults in, and what they tell.
#pragma once

#include <nlohmann/json.hpp>

#include "simulation.hpp"

namespace inkwell::virtual_board {

/// What is in now, and what is still to come.
nlohmann::json injected(Board& board);
nlohmann::json still_to_come(Board& board);
nlohmann::json inject(const nlohmann::json& request, Simulation& simulation);
nlohmann::json heal(const nlohmann::json& request, Simulation& simulation);

}  // namespace inkwell::virtual_board
