// A host that keeps to no rule: single transactions in any order, handshakes that get lost, SETUP upon SETUP, resets
// anywhere. After each batch the device must enumerate and stream as if nothing had been.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace inkwell::virtual_usb_test {

struct HostileOutcome {
  std::uint64_t cases = 0;          ///< that were gone through
  std::uint64_t answers = 0;        ///< to a SETUP that came upon another one
  std::uint64_t wrong_answers = 0;  ///< those that answer the other one
  std::uint64_t missing_answers = 0;
  /// The other one was refused in the very moment in which this one came: the core lets firmware set STALL on endpoint
  /// 0 and never clear it (RM0090, OTG_FS_DIEPCTL0), so no firmware can close these few cycles. The next SETUP is
  /// answered.
  std::uint64_t stalled_answers = 0;
  std::vector<std::string> failures;  ///< batches after which the device was not well, and rules of the chip it broke
};

/// So many cases in a row meet one board; the next ones meet a new one. A case is always the same, whatever was before
/// its row.
inline constexpr std::uint64_t hostile_cases_in_a_row = 10'000;

/// The cases `from` to before `end` of those that `seed` chooses, and what leads to them in their row. Ends at the
/// first failure.
HostileOutcome be_hostile(const std::filesystem::path& image, std::uint64_t from, std::uint64_t end,
                          std::uint64_t seed);

}  // namespace inkwell::virtual_usb_test
