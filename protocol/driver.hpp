// Reports about the driver and about request results.
//
// Several programs may be connected to one arm, but only one program drives the arm. The driver claims the arm with a
// random number and sends this claim with its commands, forces, shapes and parameters. From other programs the board
// accepts only commands that need no claim (needs_claim()). A claim expires claim_expiry_s after the last report with
// the claim.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "protocol/reports.hpp"
#include "protocol/request_result.hpp"

namespace inkwell::protocol {

/// Time after which a claim without reports expires, in board time.
inline constexpr float claim_expiry_s = 1.0f;

/// Longest program name. Longer program names are truncated.
inline constexpr std::size_t program_name_maximum = 31;

/// Returns true if the board refuses the command while another program drives the arm. Any program may stop the force
/// and select signals.
constexpr bool needs_claim(Command command) {
  return command != Command::heartbeat && command != Command::stop && command != Command::select_signals;
}

enum class ClaimOperation : std::uint8_t {
  claim = 0,      ///< no effect while another program drives the arm
  release = 1,    ///< no effect with another claim than the current one; the force ramps down
  take_over = 2,  ///< ends the claim of the other program; its force and its shapes fade
};

/// Feature report, set. The next DriverReport shows the result of the operation.
struct ClaimReport {
  ReportId report_id = ReportId::driver;
  ClaimOperation operation;
  std::uint16_t version = protocol_version;
  std::uint32_t claim;                     ///< random, not 0
  std::uint32_t process_id;                ///< process id of the program on its computer
  char program[program_name_maximum + 1];  ///< program name, padded with zeros
};

/// Feature report, get: the program that drives the arm.
struct DriverReport {
  ReportId report_id = ReportId::driver;
  std::uint8_t is_driven;  ///< 0: no program drives the arm, and claim_digest to driven_s are 0
  std::uint16_t version = protocol_version;
  std::uint32_t claim_digest;  ///< digest_of() the claim
  std::uint32_t process_id;
  /// Program name as received, padded with zeros. Filter the name before printing it to a terminal.
  char program[program_name_maximum + 1];
  std::uint32_t driven_s;      ///< board time since the program claimed the arm, in whole seconds
  std::uint32_t time_periods;  ///< board time of this report
  std::uint32_t changes;       ///< claims, releases, expiries and takeovers since start-up
  std::uint32_t refused;       ///< requests since start-up from programs that were not the driver
};

/// Returns a digest that identifies a claim without disclosing the claim.
constexpr std::uint32_t digest_of(std::uint32_t claim) {
  std::uint32_t mixed = claim ^ 0x9E3779B9u;
  mixed = (mixed ^ mixed >> 16) * 0x85EBCA6Bu;
  mixed = (mixed ^ mixed >> 13) * 0xC2B2AE35u;
  return mixed ^ mixed >> 16;
}

/// Copies the program name and replaces every byte that is not printable ASCII by `?`. Returns the length of the copy.
constexpr std::size_t copy_program_name(const char (&field)[program_name_maximum + 1],
                                        char (&name)[program_name_maximum + 1]) {
  std::size_t length = 0;
  for (; length < program_name_maximum && field[length] != '\0'; ++length)
    name[length] = field[length] >= ' ' && field[length] <= '~' ? field[length] : '?';
  name[length] = '\0';
  return length;
}

struct RequestResultEntry {
  std::uint32_t ticket;  ///< CommandReport::ticket or ShapesReport::ticket; 0 if the entry is empty
  ReportId request;      ///< `command` or `shapes`
  Command command;       ///< command of a CommandReport, otherwise 0
  RequestResult result;
  std::uint8_t reserved;
};

inline constexpr std::size_t request_results_kept = 8;

/// Feature report, get. Results of the newest commands and shapes with a ticket. A bus reset or suspend erases the
/// results and discards the queued commands.
struct RequestResultsReport {
  ReportId report_id = ReportId::request_results;
  State state;  ///< state at the time of this report
  std::uint16_t version = protocol_version;
  std::uint32_t time_periods;  ///< board time of this report
  RequestResultEntry entries[request_results_kept];
};

static_assert(sizeof(ClaimReport) == 44);
static_assert(sizeof(DriverReport) == 60);
static_assert(sizeof(RequestResultEntry) == 8 && sizeof(RequestResultsReport) == 72);

}  // namespace inkwell::protocol
