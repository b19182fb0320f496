// Names of other programs, for sentences.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>

namespace inkwell::local {

/// The text for a terminal: anything but printable ASCII becomes a question mark. Programs choose their names freely,
/// and a name could hold commands for the terminal.
std::string printable(std::string_view text);

/// "virtual-board (process 4711)", or "process 4711" if the system does not reveal the name.
std::string name_of_process(pid_t process);

}  // namespace inkwell::local
