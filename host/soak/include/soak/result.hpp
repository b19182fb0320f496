// What came of a soak: of each sitting, and of all together.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <soak/oracle.hpp>

namespace inkwell::soak {

struct PhaseResult {
  unsigned number = 0;
  std::string kind;
  double begin_s = 0, duration_s = 0;  ///< board time
  std::string what;                    ///< in words: what was put in, how much was changed
};

/// What was missing in a sitting.
struct Losses {
  unsigned long poses = 0;               ///< within a connection
  unsigned long poses_kept_back = 0;     ///< by what was put in: no finding
  unsigned long scope_samples = 0;       ///< of selections that the bus carries for sure
  unsigned long wide_scope_samples = 0;  ///< of longer ones, which the bus may be too slow for: no finding
  unsigned long program_forces = 0;
  unsigned long recorded_samples = 0;
};

/// A board from its start to its end.
struct Sitting {
  unsigned number = 0;  ///< from 1 on
  double board_time_s = 0;
  std::vector<PhaseResult> phases;
  std::vector<Finding> findings;
  std::map<std::string, unsigned> faults_put_in,
      faults_told;        ///< by name; told ones of the hand's and host's doing too
  unsigned restarts = 0;  ///< wanted ones and those of faults included
  double peak_motor_force_N = 0;
  Press hardest_press, hardest_press_with_fault, hardest_press_with_fault_over_ms;
  double longest_interrupt_part = 0;  ///< of its period
  unsigned long transactions = 0, refused_transactions = 0, poses = 0;
  Losses lost;
};

struct Soak {
  std::uint64_t seed = 1;
  double sitting_s = 0, use_s = 0;
  bool stopped = false;  ///< before the time was over: by the user, or as a board could not be used
  std::vector<Sitting> sittings;
};

std::size_t finding_count(const Soak& soak);
unsigned false_trip_count(const Soak& soak);
/// A line on each phase, or on all.
std::string line_of(const Sitting& sitting, const PhaseResult& phase);
std::string table_of(const Soak& soak);
/// The command that goes again through the sitting of a finding.
std::string repeat_command(const Soak& soak, unsigned sitting);
/// A JSON object and a line feed.
std::string json_of(const Soak& soak);

}  // namespace inkwell::soak
