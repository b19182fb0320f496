// Sections of the page about force and energy at the hand.
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

/// Worst values of all cases with the force on. The extra energy is listed only if a fault-free case exists for
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

/// The findings are the rows above the limit.
Section above_limit(const Groups& groups, const std::vector<CaseFault>& faults);
/// The findings are the cases in which bridges switched on after the injection.
Section switched_on(std::span<const Result> results);
/// Describes the force on the hand during a fling.
std::string fast_hand(std::span<const Result> results);

}  // namespace inkwell::campaign
