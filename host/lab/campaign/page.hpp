// Writes the results as Markdown pages.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "host/lab/campaign/result.hpp"

namespace inkwell::campaign {

/// Worst values of a fault in a situation.
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

/// Returns the folder for detail pages and plots, which is the path of the page without its extension. Throws
/// device::Error if the page has no extension.
std::filesystem::path folder_of_details(const std::filesystem::path& page);
/// Writes the summary page, the detail pages and the plots. Throws device::Error.
void write_page(std::span<const Result> results, const std::filesystem::path& page);

}  // namespace inkwell::campaign
