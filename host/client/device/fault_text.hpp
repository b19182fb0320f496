// Formats fault texts with the values of the board.
#pragma once

#include <string>

#include "protocol/faults.hpp"
#include "protocol/self_test.hpp"

namespace inkwell::device {

struct FaultText {
  std::string cause;
  std::string remedy;
};

FaultText fault_text(protocol::Fault fault);
/// Returns cause and remedy of a fault. For self_test_failed, returns the failed items and their remedies.
FaultText fault_text(protocol::Fault fault, const protocol::SelfTestReport& test);

/// Returns one line with name, cause and remedy of a fault.
std::string fault_line(protocol::Fault fault);
std::string fault_line(protocol::Fault fault, const protocol::SelfTestReport& test);

}  // namespace inkwell::device
