#include "host/lab/campaign/page_plots.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "host/lab/campaign/groups.hpp"
#include "host/lab/campaign/plot.hpp"

namespace inkwell::campaign {
namespace {

/// Cases with a flung arm are excluded, because the arm's inertia acts on the hand.
bool was_driven(const Result& result) {
  return result.error.empty() && result.bridges_were_on && !is_testing(result) && !is_flung(result);
}

bool is_of_wires(const CaseFault& fault) {
  if (!fault.fault) return false;
  const auto location = protocol::info(*fault.fault).location;
  return location == protocol::InjectionLocation::wire || location == protocol::InjectionLocation::wires;
}

/// Returns the largest fault-free force on the hand in each situation.
std::map<CaseSituation, double> fault_free_forces_N(std::span<const Result> results) {
  std::map<CaseSituation, double> forces_N;
  for (const Result& result : results)
    if (was_driven(result) && result.fault.is_fault_free())
      forces_N[result.situation] = std::max(forces_N[result.situation], result.peak_force_N);
  return forces_N;
}

double class_width_N(double reach_N) {
  constexpr double widths_N[] = {0.5, 1, 2, 5, 10, 20};
  constexpr double most = 10;
  for (const double width_N : widths_N)
    if (reach_N <= most * width_N) return width_N;
  return std::ceil(reach_N / most);
}

}  // namespace

double force_limit_N(std::span<const Result> results) {
  double limit_N = 0;
  for (const Result& result : results)
    if (result.error.empty()) limit_N = std::max(limit_N, result.force_limit_N);
  return limit_N;
}

std::string off_plot(std::span<const Result> results) {
  constexpr double limits[] = {1, 2, 5, 20, 100, 1000};
  std::vector<Bar> bars{{"up to 1"}};
  for (std::size_t i = 1; i < std::size(limits); ++i)
    bars.push_back({fmt::format("{} to {}", limits[i - 1], limits[i])});
  bars.push_back({fmt::format("over {}", *std::rbegin(limits))});
  bars.push_back({"stayed on"});
  unsigned wires = 0;
  for (const Result& result : results) {
    if (!was_driven(result) || result.fault.is_fault_free()) continue;
    if (result.off_after_s) {
      const auto bin = std::ranges::lower_bound(limits, *result.off_after_s / control_period_s) - std::begin(limits);
      ++bars[static_cast<std::size_t>(bin)].count;
    } else {
      ++bars.back().count;
      if (!is_unnoticed(result) || result.noticed_in_use_as.by != NoticedInUse::By::nothing) continue;
      ++bars.back().quiet;
      wires += is_of_wires(result.fault);
    }
  }
  const unsigned undetected = bars.back().quiet;
  return svg_of(
      {.title = "Simulation: time from a fault until all bridges were off, cases with the force on",
       .axis = fmt::format("time until all bridges were off, in control periods of {:.0f} μs", 1e6 * control_period_s),
       .bars = std::move(bars),
       .last_apart = true,
       .strong_means = "bridges switched off, or a fault was reported immediately or during continued use",
       .quiet_means =
           undetected == 0
               ? ""
               : fmt::format("undetected: {} of {} are wire faults, such as a faulty button wire", wires, undetected)});
}

std::string force_plot(std::span<const Result> results) {
  constexpr double as_without_N = 0.1;  // due to current noise and different instants
  const double limit_N = force_limit_N(results);
  double reach_N = limit_N;
  for (const Result& result : results)
    if (was_driven(result)) reach_N = std::max(reach_N, result.peak_force_N);
  const double width_N = class_width_N(reach_N);
  std::vector<Bar> bars(static_cast<std::size_t>(reach_N / width_N) + 1);
  std::vector<std::string> edges;
  for (std::size_t i = 0; i <= bars.size(); ++i) edges.push_back(fmt::format("{}", width_N * static_cast<double>(i)));
  const auto fault_free_N = fault_free_forces_N(results);
  bool all_compared = true;
  for (const Result& result : results) {
    if (!was_driven(result) || result.fault.is_fault_free()) continue;
    Bar& bar = bars[static_cast<std::size_t>(result.peak_force_N / width_N)];
    ++bar.count;
    const auto without = fault_free_N.find(result.situation);
    if (without == fault_free_N.end())
      all_compared = false;
    else
      bar.quiet += result.peak_force_N <= without->second + as_without_N;
  }
  std::string felt_without;
  for (const CaseSituation situation : situations)
    if (const auto without = fault_free_N.find(situation); without != fault_free_N.end())
      felt_without +=
          fmt::format("{}{} {:.1f} N", felt_without.empty() ? "" : ", ", name_of(situation), without->second);
  return svg_of(
      {.title = "Simulation: largest force on the hand after a fault, cases with the force on",
       .axis = "peak force at the hand, N",
       .bars = std::move(bars),
       .edges = std::move(edges),
       .limit = limit_N > 0 ? std::optional(Limit{limit_N / width_N, fmt::format("force limit {:.1f} N", limit_N)})
                            : std::nullopt,
       .strong_means = fmt::format("more than {} N above the same situation without a fault{}", as_without_N,
                                   all_compared ? "" : ", or without a fault-free case"),
       .quiet_means =
           felt_without.empty() ? "" : fmt::format("at most this; forces without a fault: {}", felt_without)});
}

}  // namespace inkwell::campaign
