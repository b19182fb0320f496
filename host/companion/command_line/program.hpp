// The `inkwell` program. Without a command, the program opens the window. Scripts use the commands instead of the
// window.
#pragma once

namespace inkwell::command_line {

/// Runs the program with the arguments of main(). Returns the exit code: 0 success, 1 failure, 2 wrong usage.
int run(int argument_count, char** arguments);

}  // namespace inkwell::command_line
