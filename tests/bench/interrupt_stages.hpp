#pragma once

namespace inkwell::bench {

/// Presses the arm into three walls with 31 signals on the scope and prints the largest duration of each stage.
/// Measures with the likely and with the conservative instruction costs. Writes the longest interrupt with the
/// conservative costs to `interrupt.profile` next to this program, for tools/docs/flame-graph.
void print_interrupt_stages();

}  // namespace inkwell::bench
