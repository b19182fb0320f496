// The `inkwell` program: alone it opens the window; its commands do what the window does, for scripts.
#pragma once

namespace inkwell::command_line {

/// Takes what main() is given. The exit code: 0 done, 1 the device or the work failed, 2 wrong usage.
int run(int argument_count, char** arguments);

}  // namespace inkwell::command_line
