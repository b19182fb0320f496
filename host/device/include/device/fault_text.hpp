// What a fault tells its user: the words of the protocol's table with the board's figures in them.
#pragma once

#include <string>

#include <protocol/faults.hpp>

namespace inkwell::device {

struct FaultText {
  std::string cause;
  std::string remedy;
};

FaultText fault_text(protocol::Fault fault);

/// One line with the fault's name, its cause and its remedy.
std::string fault_line(protocol::Fault fault);

}  // namespace inkwell::device
