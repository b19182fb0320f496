#pragma once

namespace inkwell::bench {

/// Presses the arm against three walls, records 31 signals and prints the largest duration of each stage. Each stage is
/// measured with the likely and with the conservative instruction costs. Writes `interrupt.profile`, the input of
/// tools/docs/flame-graph, next to this program.
void print_interrupt_stages();

}  // namespace inkwell::bench
