// Reasons why a fault or a fast hand may stay undetected, for the rows of the tables.
#pragma once

#include <string_view>

#include "host/lab/campaign/cases.hpp"

namespace inkwell::campaign {

/// Reason for a case in which the force was on and the bridges stayed on. No function of this file is called for the
/// control case.
std::string_view reason_with_force(const CaseFault& put_in);
/// Reason for a situation with the force off.
std::string_view reason_without_force(const CaseFault& put_in, CaseSituation situation);
/// Reason for a case in which the force was on and the bridges switched off.
std::string_view reason_of_silence(const CaseFault& put_in, CaseSituation situation);

}  // namespace inkwell::campaign
