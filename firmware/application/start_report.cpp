#include "start_report.hpp"

#include "parts.hpp"

namespace inkwell::application {

void report_start(const drivers::ResetCause& cause, const std::optional<drivers::CrashRecord>& crash) {
  console.start();
  console.write("inkwell " INKWELL_VERSION ", reset cause ");
  console.write_hexadecimal(cause.flags >> 24);
  if (crash) {
    console.write(", exception ");
    console.write_hexadecimal(crash->exception);
    console.write(" at ");
    console.write_hexadecimal(crash->program_counter);
    console.write(" from ");
    console.write_hexadecimal(crash->link_register);
    console.write(" status ");
    console.write_hexadecimal(crash->configurable_fault_status);
    console.write(" ");
    console.write_hexadecimal(crash->hard_fault_status);
    console.write(" address ");
    console.write_hexadecimal(crash->fault_address);
  }
  console.write("\r\n");
}

}  // namespace inkwell::application
