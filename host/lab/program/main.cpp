// The `inkwell-lab` program: long tests of the firmware on virtual boards.
#include <CLI/CLI.hpp>
#include "host/client/command_line/help.hpp"

#include "host/lab/program/commands.hpp"

int main(int argument_count, char** arguments) {
  using namespace inkwell;
  CLI::App program(
      "Laboratory of an Inkwell haptic arm: tests the firmware on virtual boards for minutes to hours\n"
      "Virtual boards simulate the board, the arm and the hand. Nothing is sent to a real arm.",
      "inkwell-lab");
  command_line::set_help_style(program);
  program.set_version_flag("--version", INKWELL_VERSION, "Print the version");
  program.set_help_flag("-h,--help", "Print this help");
  program.footer(
      "Examples:\n"
      "  inkwell-lab campaign --jobs 8\n"
      "  inkwell-lab soak --seconds 3600 --jobs 8 --out soak.json\n"
      "\n"
      "`inkwell-lab COMMAND --help` describes a command. The options above may precede or follow the command.\n"
      "Times are in seconds of board time, forces in newtons.\n"
      "Exit code: 0 success, 1 the command failed or found a problem, 2 wrong usage.");
  program.require_subcommand(1);
  program.fallthrough();  // the options of virtual boards may also follow the command

  command_line::DeviceOptions options;
  command_line::Action action;
  options.add_board_to(program);
  const lab::CommandContext context{program, options, action};
#define X(name) lab::add_##name##_command(context);
  INKWELL_LAB_COMMANDS(X)
#undef X
  return command_line::run_program(program, argument_count, arguments, action);
}
