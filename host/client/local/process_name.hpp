// Names of other programs, for error sentences.
#pragma once

#include <sys/types.h>

#include <string>

namespace inkwell::local {

/// For example "virtual-board (process 4711)", or "process 4711" without a name. The text is safe to print.
std::string name_of_process(pid_t process);

}  // namespace inkwell::local
