// The commands of the control socket.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace inkwell::virtual_board {

class Simulation;

/// Executes one command line of a client and returns the reply: {"ok":true,...} or {"ok":false,"error":"sentence"}. The
/// reply to `run` follows at the end of the run.
nlohmann::json carry_out(const std::string& line, Simulation& simulation);
/// Executes a command line in the middle of a USB frame, and refuses commands that change the board.
nlohmann::json carry_out_within_frame(const std::string& line, Simulation& simulation);

}  // namespace inkwell::virtual_board
