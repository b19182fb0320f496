// Why a fault may pass without a word, as far as its row of the table tells.
#pragma once

#include <string_view>

#include <protocol/injections.hpp>

namespace inkwell::campaign {

/// The force is on, and the bridges stayed on; `of` is the place, as CaseFault has it.
std::string_view reason_with_force(protocol::InjectedFault fault, std::string_view of);
/// The force is off.
std::string_view reason_without_force(protocol::InjectedFault fault, std::string_view of);
/// The force was on, and the bridges went off.
std::string_view reason_of_silence(protocol::InjectedFault fault, std::string_view of);

}  // namespace inkwell::campaign
