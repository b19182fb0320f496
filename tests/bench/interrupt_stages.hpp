// What the stages of the control interrupt cost at worst.
#pragma once

namespace inkwell::bench {

/// Presses the arm into three walls with 31 signals on the scope, by the likely and by the conservative prices of
/// instructions, and prints the longest of each stage. Leaves the longest interrupt by
/// the conservative prices in `interrupt.profile` beside this program, for tools/flame-graph.
void print_interrupt_stages();

}  // namespace inkwell::bench
