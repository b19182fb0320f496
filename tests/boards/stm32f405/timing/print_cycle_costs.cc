// Prints the table of docs/cycles.md from the costs in the code.
#include <cstdio>
#include "boards/stm32f405/timing/costs.hpp"

int main() {
  using namespace inkwell::virtual_board;
  const auto source = [](Source from) {
    switch (from) {
      case Source::reference_manual: return "Arm";
      case Source::compiler: return "GCC";
      case Source::chip_manual: return "RM0090";
      case Source::measured: return "measured";
      case Source::guess: return "guess";
    }
    return "";
  };
  std::puts("| cost | likely | conservative | source |");
  std::puts("| --- | --- | --- | --- |");
  for (const auto& row : cost_table)
    std::printf("| `%s` | %u | %u | %s |\n", row.name.data(), row.likely, row.conservative, source(row.source));
}
