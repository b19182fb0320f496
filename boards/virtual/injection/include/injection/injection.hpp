// A fault that is asked for, as a command line, a script or a client of the control socket writes it, checked against
// protocol/injections.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <board/facts.hpp>
#include <chip/pin_name.hpp>
#include <protocol/injection_request.hpp>

namespace inkwell::virtual_board {

/// What was asked for can not be; what() is a sentence that says what would.
class InvalidInjection : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Injection {
  protocol::InjectedFault fault;
  std::string of;                        ///< under its full name; empty where there is one only
  unsigned number = 0;                   ///< of the motor (from 0), the exception or the converter
  unsigned leg = 0;                      ///< 0 is A
  std::array<PinName, 2> wires{};        ///< one or two
  std::optional<std::uint32_t> address;  ///< none: by the seed
  double amount = 0.0;
  double after_s = 0.0;
  std::optional<double> for_s;  ///< then it is healed
};

/// For a board, whose wires it may name. All throw InvalidInjection.
Injection checked(const protocol::InjectionRequest& request, const board::Facts& board);
/// NAME[:OF][=AMOUNT][@AFTER][+FOR], such as encoder_lost_counts:2=0.05@1.5+0.2; times in seconds.
Injection parse_injection(std::string_view text, const board::Facts& board);
/// One a line; what follows a # is a comment. Names the line that is wrong.
std::vector<Injection> parse_injections(std::string_view script, const board::Facts& board);

/// The table for --help, a line each.
std::string explain_injections();

}  // namespace inkwell::virtual_board
