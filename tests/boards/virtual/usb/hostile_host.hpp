// This host breaks the protocol: transactions in any order, lost handshakes, repeated SETUP packets, resets.
// After each batch the device must enumerate and stream normally.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace inkwell::virtual_usb_test {

struct HostileOutcome {
  std::uint64_t cases = 0;          ///< completed cases
  std::uint64_t answers = 0;        ///< to a SETUP that followed another SETUP
  std::uint64_t wrong_answers = 0;  ///< answers to the earlier SETUP
  std::uint64_t missing_answers = 0;
  /// Number of stalled answers. A SETUP packet receives a STALL if it arrives while the device refuses the previous
  /// SETUP packet. Firmware cannot clear STALL on endpoint 0 (RM0090, OTG_FS_DIEPCTL0).
  std::uint64_t stalled_answers = 0;
  std::vector<std::string> failures;  ///< batches after which the device did not work, and violated rules of the chip
};

/// Number of consecutive cases on one board. The result of a case depends on the previous cases of the same board.
inline constexpr std::uint64_t hostile_cases_in_a_row = 10'000;

/// Runs the cases from `from` to `end` (exclusive) of the sequence that `seed` generates. First repeats the preceding
/// cases of the same board. Stops at the first failure.
HostileOutcome be_hostile(const std::filesystem::path& image, std::uint64_t from, std::uint64_t end,
                          std::uint64_t seed);

}  // namespace inkwell::virtual_usb_test
