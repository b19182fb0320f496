#include "start_report.hpp"

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
  console.start();
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

}  // namespace inkwell::application
