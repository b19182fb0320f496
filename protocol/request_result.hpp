// Results of requests without a separate result report: commands, shapes and black-box rows.
//
// The board reports a full queue or a refusal as a result, never as a USB stall. Some hosts cannot distinguish a stall
// from an unplugged device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace inkwell::protocol {

// clang-format off
/// X(code, name, meaning, remedy)
#define INKWELL_REQUEST_RESULTS(X)                                                                                     \
  X(0, waiting, "The board has queued the command. The control interrupt carries it out in one of its next periods.", "Read the result again.") \
  X(1, carried_out, "The control interrupt has carried out the command.", "Nothing to do.")                            \
  X(2, not_the_driver, "The request came from a program that does not drive the arm, so the board refused it.", "Claim the arm, or take it over from the program that drives it.") \
  X(3, accepted, "The board has accepted the request. Shapes apply from the next control period on.", "Nothing to do.") \
  X(4, busy, "The board dropped the request, because the control interrupt had not processed an earlier request yet.", "Send the request again.") \
  X(5, malformed, "The request has a wrong version or length, or values that are not allowed, so the board refused it.", "Use the companion version that matches the firmware, and values within the ranges of the protocol.")
// clang-format on

enum class RequestResult : std::uint8_t {
#define X(code, name, ...) name = code,
  INKWELL_REQUEST_RESULTS(X)
#undef X
};

struct RequestResultInfo {
  std::string_view name;
  std::string_view meaning;
  std::string_view remedy;
};

inline constexpr auto request_result_table = std::to_array<RequestResultInfo>({
#define X(code, name, meaning, remedy) {#name, meaning, remedy},
    INKWELL_REQUEST_RESULTS(X)
#undef X
});

inline constexpr RequestResultInfo unknown_request_result{"unknown",
                                                          "The device sent a result that is unknown to this companion.",
                                                          "Use the companion version that matches the firmware."};

constexpr const RequestResultInfo& info(RequestResult result) {
  const auto code = static_cast<std::size_t>(result);
  return code < request_result_table.size() ? request_result_table[code] : unknown_request_result;
}

#define X(code, label, ...) static_assert(request_result_table[code].name == #label, "the codes count up from 0");
INKWELL_REQUEST_RESULTS(X)
#undef X

}  // namespace inkwell::protocol
