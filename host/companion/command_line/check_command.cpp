#include "host/client/command_line/help.hpp"

#include "host/companion/command_line/guide_commands.hpp"

namespace inkwell::command_line {

void add_check_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand("check", "Guides that check the wiring and the arm description");
  command->require_subcommand(1);
  add_examples(*command, "inkwell check connection\ninkwell check directions");
  add_guides(*command, context, "check");
}

}  // namespace inkwell::command_line
