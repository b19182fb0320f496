#include "start_report.hpp"

#include <drivers/clocks.hpp>

#include <string_view>

#include "parts.hpp"

namespace inkwell::application {
namespace {

struct CrashWord {
  std::string_view label;
  std::uint32_t drivers::CrashRecord::*word;
};

constexpr CrashWord crash_words[] = {
    {", exception ", &drivers::CrashRecord::exception}, {" at ", &drivers::CrashRecord::program_counter},
    {" from ", &drivers::CrashRecord::link_register},   {" status ", &drivers::CrashRecord::configurable_fault_status},
    {" ", &drivers::CrashRecord::hard_fault_status},    {" address ", &drivers::CrashRecord::fault_address},
};

}  // namespace

void report_start(const drivers::ResetCause& cause, const std::optional<drivers::CrashRecord>& crash) {
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
