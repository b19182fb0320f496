// Fault requested by the command line, a script or a client of the control socket. The request has passed the checks of
// protocol/injections.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "boards/facts/board_facts.hpp"
#include "boards/stm32f405/peripherals/pin_name.hpp"
#include "protocol/injection_request.hpp"

namespace inkwell::virtual_board {

/// Thrown for an invalid request.
class InvalidInjection : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Injection {
  protocol::InjectedFault fault;
  std::string of;                        ///< full name of the location; empty if the fault has only one location
  unsigned number = 0;                   ///< index of the motor (from 0), the exception or the converter
  unsigned leg = 0;                      ///< 0 is A
  std::array<PinName, 2> wires{};        ///< one or two
  std::optional<std::uint32_t> address;  ///< std::nullopt: chosen from the seed
  double amount = 0.0;
  double after_s = 0.0;
  std::optional<double> for_s;  ///< duration, after which the fault is cleared
};

/// Checks a request. The wires of the request must exist on `board`. Throws InvalidInjection.
Injection checked(const protocol::InjectionRequest& request, const board::Facts& board);
/// Parses NAME[:OF][=AMOUNT][@AFTER][+FOR], such as encoder_lost_counts:2=0.05@1.5+0.2. The times are in seconds.
/// Throws InvalidInjection.
Injection parse_injection(std::string_view text, const board::Facts& board);
/// Parses one injection per line and ignores the text after a #. Throws InvalidInjection with the number of the invalid
/// line.
std::vector<Injection> parse_injections(std::string_view script, const board::Facts& board);

/// Returns the help text with one line per injection.
std::string explain_injections();

}  // namespace inkwell::virtual_board
