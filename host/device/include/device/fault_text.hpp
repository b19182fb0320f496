// What a fault tells its user: the words of the protocol's table with the board's figures in them.
#pragma once

#include <string>

#include <protocol/faults.hpp>
#include <protocol/self_test.hpp>

namespace inkwell::device {

struct FaultText {
  std::string cause;
  std::string remedy;
};

FaultText fault_text(protocol::Fault fault);
/// The same, and of self_test_failed what failed in this test, with the remedies of its items.
FaultText fault_text(protocol::Fault fault, const protocol::SelfTestReport& test);

/// One line with the fault's name, its cause and its remedy.
std::string fault_line(protocol::Fault fault);
std::string fault_line(protocol::Fault fault, const protocol::SelfTestReport& test);

}  // namespace inkwell::device
