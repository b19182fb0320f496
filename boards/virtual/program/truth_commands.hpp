// Control socket commands for the true physical quantities of the simulation.
#pragma once

#include <string_view>

#include <nlohmann/json.hpp>

#include "boards/virtual/program/simulation.hpp"

namespace inkwell::virtual_board {

std::string_view name_of(PinLevel level);
nlohmann::json truth(const nlohmann::json& request, Simulation& simulation);
nlohmann::json meter(const nlohmann::json& request, Simulation& simulation);
nlohmann::json trace(const nlohmann::json& request, Simulation& simulation);

}  // namespace inkwell::virtual_board
