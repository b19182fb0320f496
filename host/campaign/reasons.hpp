// Why a fault, or a fast hand, may pass without a word, as far as its row of the table tells.
#pragma once

#include <string_view>

#include <campaign/cases.hpp>

namespace inkwell::campaign {

/// The force is on, and the bridges stayed on. None of the three is asked of the control.
std::string_view reason_with_force(const CaseFault& put_in);
/// The force is off, in that situation.
std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation);
/// The force was on, in that situation, and the bridges went off.
std::string_view reason_of_silence(const CaseFault& put_in, CaseSituation situation);

}  // namespace inkwell::campaign
