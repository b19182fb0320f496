// Fault texts from the protocol's table, with the board's values inserted.
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
/// Cause and remedy of a fault; for self_test_failed, the failed items and their remedies.
FaultText fault_text(protocol::Fault fault, const protocol::SelfTestReport& test);

/// One line with the fault's name, its cause and its remedy.
std::string fault_line(protocol::Fault fault);
std::string fault_line(protocol::Fault fault, const protocol::SelfTestReport& test);

}  // namespace inkwell::device
