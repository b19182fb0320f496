// The commands of the control socket.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace inkwell::virtual_board {

class Simulation;

/// Executes one command line of a client and returns the reply: {"ok":true,...} or {"ok":false,"error":"sentence"}. For
/// the command `run`, the simulation sends the reply after the duration of the run.
nlohmann::json carry_out(const std::string& line, Simulation& simulation);
/// Executes a command line while board time waits for a program in the middle of a USB frame. Commands that change the
/// board are refused.
nlohmann::json carry_out_within_frame(const std::string& line, Simulation& simulation);

}  // namespace inkwell::virtual_board
