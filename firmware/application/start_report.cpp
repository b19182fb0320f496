#include "start_report.hpp"

#include <drivers/clocks.hpp>

#include <string_view>

#include "parts.hpp"

namespace inkwell::application {
namespace {

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

void report_start(const drivers::ResetCause& cause, const std::optional<protocol::CrashFacts>& crash) {
  console.start(board::apb1_Hz);
  console.write("inkwell " INKWELL_VERSION ", reset cause ");
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
                ", the crystal does not swing: no USB and no motors until it does. Check it, its two capacitors and "
                "their joints.\r\n");
}

}  // namespace inkwell::application
