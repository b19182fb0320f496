#include "firmware/application/start_report.hpp"

#include "firmware/drivers/clocks.hpp"

#include <array>
#include <string_view>

#include "firmware/application/parts.hpp"

namespace inkwell::application {

namespace {

constexpr auto board_name() {
  std::array<char, board::facts.name.size() + 1> text{};
  board::facts.name.copy(text.data(), text.size());
  return text;
}

struct CrashWord {
  std::string_view label;
  std::uint32_t protocol::CrashFacts::*word;
};

constexpr CrashWord crash_words[] = {
    {", exception ", &protocol::CrashFacts::exception}, {" at ", &protocol::CrashFacts::program_counter},
    {" from ", &protocol::CrashFacts::link_register},   {" status ", &protocol::CrashFacts::configurable_fault_status},
    {" ", &protocol::CrashFacts::hard_fault_status},    {" address ", &protocol::CrashFacts::fault_address},
};

}  // namespace

/// The virtual board reads the board name from the ELF file to select the wiring.
extern "C" {
extern const std::array<char, board::facts.name.size() + 1> inkwell_board_name;
const std::array<char, board::facts.name.size() + 1> inkwell_board_name = board_name();
}

void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash) {
  console.start(board::apb1_Hz);
  console.write("inkwell " INKWELL_VERSION " for ");
  console.write({inkwell_board_name.data(), inkwell_board_name.size() - 1});
  console.write(", reset cause ");
  console.write_hexadecimal(cause.flags >> 24);
  if (crash) {
    for (const auto& [label, word] : crash_words) {
      console.write(label);
      console.write_hexadecimal((*crash).*word);
    }
  }
  console.write("\r\n");
}

void report_no_crystal() {
  console.start(drivers::internal_oscillator_Hz);
  console.write("inkwell " INKWELL_VERSION
                ", the crystal does not oscillate: USB and motors stay off. Check the crystal, its capacitors and "
                "their joints.\r\n");
}

}  // namespace inkwell::application
