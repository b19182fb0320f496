// Sections about the hand: force, energy, and bridges that switched on unexpectedly.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/lab/campaign/groups.hpp"
#include "host/lab/campaign/section.hpp"

namespace inkwell::campaign {

/// Noise may raise the measured force to this multiple of the force limit.
inline constexpr double tolerated_part_of_limit = 1.05;

/// Worst values of all cases with the force on. The extra energy is listed only where a fault-free run exists for
/// comparison.
class AtTheHand {
 public:
  AtTheHand(const Groups& groups, const std::vector<CaseFault>& faults);

  std::string force_text() const;
  std::string energy_text() const;
  std::string section() const;

 private:
  struct Worst {
    double value = 0.0;
    std::string where;
    void see(double other, const Result& result);
  };
  Worst force_N_, more_J_;
  std::vector<std::string_view> not_compared_;  ///< situations
};

/// Findings: rows above the limit.
Section above_limit(const Groups& groups, const std::vector<CaseFault>& faults);
/// Findings: cases in which bridges switched on, although they were off at the injection.
Section switched_on(std::span<const Result> results);
/// Force on the hand that flings the arm, with the force on and off.
std::string fast_hand(std::span<const Result> results);

}  // namespace inkwell::campaign
