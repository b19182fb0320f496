// Cases with a known result.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/lab/campaign/result.hpp"
#include "protocol/faults.hpp"

namespace inkwell::campaign {

/// Limit for electrical faults, in control periods.
inline constexpr double quick_periods = 2;

struct Expected {
  std::string_view name;  ///< Case::name()
  protocol::Fault detected_as;
  protocol::Fault or_as;  ///< alternative, which depends on the instant; otherwise the same fault
  double longest_off_periods;
  /// tools/test runs only the cases of the sample. `inkwell-lab campaign check` runs all expected cases.
  bool is_in_sample;
};

std::span<const Expected> expected_cases();
/// Returns the case with this name. Throws device::Error if no case has the name.
Case case_named(std::string_view name);
/// Returns the name of the fault-free case with the same motion. Returns an empty text if the arm is at rest.
std::string fault_free_name(const Case& the_case);
/// Returns a sentence for each difference between the result and the expectation. `energy_without_fault_J` is the
/// energy in the fault-free case, or 0 if the arm is at rest.
std::vector<std::string> deviations(const Expected& expected, const Result& result, double energy_without_fault_J);

}  // namespace inkwell::campaign
