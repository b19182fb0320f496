// The program that drives the arm, and the results of its commands and shapes.
//
// Several programs may be connected to one arm. One of them drives it: it has claimed the arm with a random number, and
// stamps its commands, forces, shapes and parameters with that claim. The board accepts them from no other program,
// except for `stop`. Every report with the claim renews it; after claim_expiry_s of silence the claim ends.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include <protocol/reports.hpp>
#include <protocol/request_result.hpp>

namespace inkwell::protocol {

/// Board time after the last report with a claim, after which the claim ends.
inline constexpr float claim_expiry_s = 1.0f;

/// Letters of a program's name; the rest of a longer name is cut off.
inline constexpr std::size_t program_name_maximum = 31;

/// Whether a command is refused while another program drives the arm. Anybody may stop the force and read signals.
constexpr bool needs_claim(Command command) {
  return command != Command::heartbeat && command != Command::stop && command != Command::select_signals;
}

enum class ClaimOperation : std::uint8_t {
  claim = 0,      ///< without effect while another program drives the arm
  release = 1,    ///< without effect for any claim but the one that is held. A force that is on falls
  take_over = 2,  ///< ends the claim of the other program. Its force and its shapes fade
};

/// Feature report, set. Whether it had an effect is in the DriverReport that follows.
struct ClaimReport {
  ReportId report_id = ReportId::driver;
  ClaimOperation operation;
  std::uint16_t version = protocol_version;
  std::uint32_t claim;                     ///< random, not 0
  std::uint32_t process_id;                ///< of the program, on its computer
  char program[program_name_maximum + 1];  ///< its name, padded with zeros
};

/// Feature report, get: the program that drives the arm.
struct DriverReport {
  ReportId report_id = ReportId::driver;
  std::uint8_t is_driven;  ///< 0: no program drives the arm, and the next five are 0
  std::uint16_t version = protocol_version;
  std::uint32_t claim_digest;  ///< digest_of() its claim
  std::uint32_t process_id;
  char program[program_name_maximum + 1];  ///< as the program wrote it: filter it before it reaches a terminal
  std::uint32_t driven_s;                  ///< whole seconds of board time since it claimed the arm
  std::uint32_t time_periods;              ///< now
  std::uint32_t changes;                   ///< of the driver since the start: claims, releases, losses, takeovers
  std::uint32_t refused;                   ///< requests since the start that came from programs that do not drive
};

/// Tells one claim from another without naming it, so that no program uses a claim of another by mistake.
constexpr std::uint32_t digest_of(std::uint32_t claim) {
  std::uint32_t mixed = claim ^ 0x9E3779B9u;
  mixed = (mixed ^ mixed >> 16) * 0x85EBCA6Bu;
  mixed = (mixed ^ mixed >> 13) * 0xC2B2AE35u;
  return mixed ^ mixed >> 16;
}

/// The name in a report: up to its first zero, with `?` for every byte that is not printable ASCII.
constexpr std::size_t copy_program_name(const char (&field)[program_name_maximum + 1],
                                        char (&name)[program_name_maximum + 1]) {
  std::size_t length = 0;
  for (; length < program_name_maximum && field[length] != '\0'; ++length)
    name[length] = field[length] >= ' ' && field[length] <= '~' ? field[length] : '?';
  name[length] = '\0';
  return length;
}

struct RequestResultEntry {
  std::uint32_t ticket;  ///< CommandReport::ticket or ShapesReport::ticket; 0 for an empty entry
  ReportId request;      ///< command or shapes
  Command command;       ///< of a CommandReport, else 0
  RequestResult result;
  std::uint8_t reserved;
};

inline constexpr std::size_t request_results_kept = 8;

/// Feature report, get: the results of the newest commands and shapes that have a ticket, of all programs. They are
/// forgotten when the bus is reset or suspended, together with the commands that waited.
struct RequestResultsReport {
  ReportId report_id = ReportId::request_results;
  State state;  ///< now
  std::uint16_t version = protocol_version;
  std::uint32_t time_periods;  ///< now
  RequestResultEntry entries[request_results_kept];
};

static_assert(sizeof(ClaimReport) == 44);
static_assert(sizeof(DriverReport) == 60);
static_assert(sizeof(RequestResultEntry) == 8 && sizeof(RequestResultsReport) == 72);

}  // namespace inkwell::protocol
