// The results as a page: what each fault did in each situation, and all that was not noticed.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <campaign/result.hpp>

namespace inkwell::campaign {

/// What is told of the cases of a fault in a situation: the worst of them.
struct Summary {
  unsigned cases = 0;       ///< that could be run
  unsigned detected = 0;    ///< a fault was told, or the board restarted; bridges that went off alone are none
  std::string detected_as;  ///< faults, restarts and lock-ups; empty: none of them
  unsigned went_off = 0, were_on = 0;
  double off_after_s = 0;
  double peak_force_N = 0, energy_J = 0, travel_m = 0;
  std::string recovery;  ///< all that were needed
  double position_error_m = 0;
};
Summary summarise(std::span<const Result> results);

/// Writes the page, and its plots beside it under its name. Throws device::Error.
void write_page(std::span<const Result> results, const std::filesystem::path& page);

}  // namespace inkwell::campaign
