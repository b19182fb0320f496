// The results as pages: a summary, the effect of each fault in each situation, and all undetected faults.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// Worst values of all cases of one fault in one situation.
struct Summary {
  unsigned cases = 0;       ///< number of completed cases
  unsigned detected = 0;    ///< a fault was reported, or the board restarted; switching the bridges off alone does not
                            ///< count
  std::string detected_as;  ///< faults, restarts and lock-ups; empty if none
  unsigned went_off = 0, were_on = 0;
  double off_after_s = 0;
  double peak_force_N = 0, energy_J = 0, travel_m = 0;
  std::string recovery;  ///< all required recovery actions
  double position_error_m = 0;
};
Summary summarise(std::span<const Result> results);

/// Folder of the detail pages and plots: the path of the page without its extension. Throws device::Error if the page
/// has no extension.
std::filesystem::path folder_of_details(const std::filesystem::path& page);
/// Writes the summary page, and the detail pages and plots to their folder. Throws device::Error.
void write_page(std::span<const Result> results, const std::filesystem::path& page);

}  // namespace inkwell::campaign
