// The commands of the control socket.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace inkwell::virtual_board {

class Simulation;

/// Carries out one line of a client and returns the reply: {"ok":true,...} or {"ok":false,"error":"sentence"}.
/// After `run` the simulation answers by itself, once the time has passed.
nlohmann::json carry_out(const std::string& line, Simulation& simulation);
/// The same in the middle of a frame, in which board time waits for a program: what would change the board is refused.
nlohmann::json carry_out_within_frame(const std::string& line, Simulation& simulation);

}  // namespace inkwell::virtual_board
