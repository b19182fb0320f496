// Result of one case.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/lab/campaign/cases.hpp"
#include "protocol/faults.hpp"

namespace inkwell::campaign {

/// State of the earlier fault after the injection.
enum class FirstFault : std::uint8_t {
  none,       ///< there was no earlier fault, or the board could not be read
  reported,   ///< the fault is still reported
  black_box,  ///< the board restarted, and its black box contains the fault
  lost,
};

/// Action that restored the force.
enum class Recovery : std::uint8_t {
  unknown,  ///< the case could not be run
  none_needed,
  clear_fault,
  force_on_again,
  board_reset,
  not_recovered,
};
/// Returns the name in files and pages, or an empty text for Recovery::unknown.
std::string_view name_of(Recovery recovery);

/// Detection during continued use of the arm.
struct NoticedInUse {
  enum class By : std::uint8_t { nothing, fault, restart, force_off };
  By by = By::nothing;
  protocol::Fault fault = protocol::Fault::none;  ///< with By::fault

  bool operator==(const NoticedInUse&) const = default;
};
/// Returns the fault name, `restart`, `force off` or an empty text.
std::string_view name_of(const NoticedInUse& noticed);

/// Returns the fault name, or an empty text for Fault::none.
std::string_view name_of_reported(protocol::Fault fault);

struct Result {
  using Fault = protocol::Fault;

  unsigned number = 0;
  CaseFault fault;
  CaseSituation situation = CaseSituation::unreferenced;
  unsigned phase = 1;
  std::string error;  ///< reason why the case could not be run; the other members are invalid then

  double injected_at_s = 0;  ///< board time
  std::string location;      ///< chosen from the seed; empty if the case names it
  bool bridges_were_on = false;
  std::optional<double> off_after_s;  ///< std::nullopt: the bridges were off, or stayed on
  bool bridges_went_on = false;       ///< the bridges were switched on, although they were off at the injection
  Fault detected_as = Fault::none;
  Fault fault_on_healing = Fault::none;  ///< fault reported only after the cause was removed
  Fault told_before = Fault::none;       ///< fault reported at the time of the injection
  FirstFault first_fault = FirstFault::none;
  Fault told_once_cleared =
      Fault::none;        ///< reported after the earlier fault was cleared, with the cause still present
  unsigned restarts = 0;  ///< in addition to the restarts of the situation
  bool locked_up = false;
  bool missed_boot_loader = false;  ///< the boot loader was requested but does not run at the end

  double force_limit_N = 0;
  double peak_force_N = 0, energy_J = 0, travel_m = 0;  ///< at the hand, after the injection
  NoticedInUse noticed_in_use_as;                       ///< if no fault was reported before
  std::optional<double> noticed_in_use_s;               ///< time since the start of the use
  std::optional<double> peak_force_in_use_N;            ///< at the hand; std::nullopt without continued use
  std::optional<double> energy_in_use_J;                ///< delivered to the hand
  Recovery recovery = Recovery::unknown;
  std::optional<double> position_error_m;  ///< error of the device's position at the end

  bool operator==(const Result&) const = default;
};

/// Returns true if a fault was reported or the board restarted. A lock-up is not a detection.
bool is_detected(const Result& result);
/// Returns true if the fault was not detected and the bridges did not switch off.
bool is_unnoticed(const Result& result);

/// Returns the reported faults, the restarts and the lock-up, or an empty text.
std::string fault_text(const Result& result);

/// Returns a JSON object and a line feed. The text contains the names of faults, situations and actions.
std::string text_of(const Result& result);
/// Throws device::Error if the text is not a result.
Result parse_result(const std::string& text);

std::filesystem::path file_of(const std::filesystem::path& directory, unsigned number);
/// Writes the file atomically, so that a killed program leaves no partial file. Throws device::Error.
void save(const Result& result, const std::filesystem::path& directory);
/// Results by number. Throws device::Error if a file is damaged or belongs to another list of cases.
std::vector<Result> load_all(const std::filesystem::path& directory);

}  // namespace inkwell::campaign
