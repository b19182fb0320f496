// What came of one case, and its file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <campaign/cases.hpp>

namespace inkwell::campaign {

/// What became of a fault that was told before.
enum class FirstFault : std::uint8_t {
  none,       ///< there was none, or nobody could ask the board
  told,       ///< it is still the one that is told
  black_box,  ///< the board started anew, and its black box has it
  lost,
};

struct Result {
  unsigned number = 0;
  std::string fault;  ///< CaseFault::name()
  std::string situation;
  unsigned phase = 1;
  std::string error;  ///< why the case could not be run; the rest says nothing then

  double injected_at_s = 0;  ///< board time
  std::string place;         ///< that the seed chose; empty: the case names it
  bool bridges_were_on = false;
  std::optional<double> off_after_s;  ///< none: they were off, or stayed on
  bool bridges_went_on = false;       ///< though they were off
  std::string detected_as;            ///< name of the firmware's fault; empty: none
  std::string fault_on_healing;       ///< that came only when the cause had gone
  std::string told_before;            ///< the fault that was told when this one came; empty: none
  FirstFault first_fault = FirstFault::none;
  std::string told_once_cleared;  ///< that came when the one before had been cleared, with the cause still there
  unsigned restarts = 0;          ///< beside those that the situation brings
  bool locked_up = false;
  bool missed_boot_loader = false;  ///< was not in it in the end, though it had been asked for

  double force_limit_N = 0;
  double peak_force_N = 0, energy_J = 0, travel_m = 0;  ///< at the hand, after the fault came
  /// Of a fault that was not told with the force on, what was told while the arm was used on; empty: nothing.
  std::string noticed_in_use_as;
  std::optional<double> noticed_in_use_s;     ///< since then
  std::optional<double> peak_force_in_use_N;  ///< at the hand; none: it was not used on
  std::optional<double> energy_in_use_J;      ///< given to the hand
  std::string recovery;                       ///< what gave the force back; the page shows it as it is
  std::optional<double> position_error_m;     ///< in the end, of what the device believes

  bool operator==(const Result&) const = default;
};

/// A fault was told, or the board restarted; a lock-up is what the fault did, not what the board noticed of it.
bool is_detected(const Result& result);
/// Neither that, nor did the bridges go off.
bool is_unnoticed(const Result& result);

/// Faults, restarts and a lock-up; empty: none of them.
std::string told(const Result& result);

/// A JSON object with a member for each field, and a line feed.
std::string text_of(const Result& result);
/// Throws device::Error if it is no result.
Result parse_result(const std::string& text);

/// The file of a case in the folder.
std::filesystem::path file_of(const std::filesystem::path& directory, unsigned number);
/// Whole or not at all, so that a job that is killed leaves no half of a result. Throws device::Error.
void save(const Result& result, const std::filesystem::path& directory);
/// By number. A file that is damaged, or of another list of cases, is an error that names it.
std::vector<Result> load_all(const std::filesystem::path& directory);

}  // namespace inkwell::campaign
