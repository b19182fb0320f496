// Results of a soak.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "host/lab/soak/oracle.hpp"
#include "protocol/injections.hpp"

namespace inkwell::soak {

struct PhaseResult {
  unsigned number = 0;
  Kind kind{};
  double begin_s = 0, duration_s = 0;  ///< board time
  std::string what;                    ///< description: injected fault, number of changes
};

struct Losses {
  unsigned long poses = 0;               ///< within a connection
  unsigned long poses_kept_back = 0;     ///< due to the injected fault; not a finding
  unsigned long scope_samples = 0;       ///< of selections within the capacity of the bus
  unsigned long wide_scope_samples = 0;  ///< of larger selections, which may exceed the capacity of the bus; not a
                                         ///< finding
  unsigned long program_forces = 0;
  unsigned long recorded_samples = 0;
};

/// The run of one virtual board.
struct Sitting {
  unsigned number = 0;  ///< from 1
  double board_time_s = 0;
  std::vector<PhaseResult> phases;
  std::vector<Finding> findings;
  std::map<protocol::InjectedFault, unsigned> faults_put_in;
  std::map<protocol::Fault, unsigned> faults_told;  ///< includes faults caused by hand and host
  unsigned restarts = 0;                            ///< including intended restarts and restarts due to faults
  double peak_motor_force_N = 0;
  Press hardest_press, hardest_press_with_fault, hardest_press_with_fault_over_ms;
  double longest_interrupt_part = 0;  ///< longest control interrupt, as a fraction of its period
  unsigned long transactions = 0, refused_transactions = 0, poses = 0;
  Losses lost;
};

struct Soak {
  std::uint64_t seed = 1;
  double sitting_s = 0, use_s = 0;
  bool stopped = false;  ///< before the end of the time: by the user, or because a board was unusable
  std::vector<Sitting> sittings;
};

std::size_t finding_count(const Soak& soak);
unsigned false_trip_count(const Soak& soak);
/// Returns a line about the phase.
std::string line_of(const Sitting& sitting, const PhaseResult& phase);
std::string table_of(const Soak& soak);
/// Returns the command that repeats this sitting.
std::string repeat_command(const Soak& soak, unsigned sitting);
/// Returns a JSON object and a line feed.
std::string json_of(const Soak& soak);

}  // namespace inkwell::soak
