#include <fmt/format.h>

#include "host/companion/command_line/commands.hpp"

namespace inkwell::command_line {

void add_moved_commands(CLI::App& program) {
  for (const char* name : {"campaign", "soak"}) {
    const std::string sentence =
        fmt::format("`inkwell {0}` is now `inkwell-lab {0}`, in the package inkwell-lab.", name);
    auto* command = program.add_subcommand(name, sentence);
    command->group("");  // not in the list of commands
    // Accepts and ignores any arguments.
    command->set_help_flag();
    command->fallthrough(false);
    command->prefix_command();
    command->callback([sentence] { throw UsageError(sentence); });
  }
}

}  // namespace inkwell::command_line
