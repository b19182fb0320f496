// Reasons why a fault or a fast hand may stay undetected.
#pragma once

#include <string_view>

#include "host/lab/campaign/cases.hpp"

namespace inkwell::campaign {

/// Returns the reason why the board did not switch the bridges off. The functions accept any fault except the control
/// case.
std::string_view reason_with_force(const CaseFault& put_in);
/// Returns the reason for an undetected fault with the force off.
std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation);
/// Returns the reason why the board switched the bridges off without a report.
std::string_view reason_of_silence(const CaseFault& put_in, CaseSituation situation);

}  // namespace inkwell::campaign
