#include "host/companion/command_line/program.hpp"

#include <CLI/CLI.hpp>
#include "host/client/command_line/help.hpp"
#include "host/client/command_line/run_program.hpp"

#include "host/companion/command_line/commands.hpp"

namespace inkwell::command_line {
namespace {

/// Adds the help text and the version.
void describe(CLI::App& program) {
  set_help_style(program);
  program.set_version_flag("--version", INKWELL_VERSION, "Print the version");
  program.set_help_flag("-h,--help", "Print this help");
  program.footer(
      "Examples:\n"
      "  inkwell --virtual                            the window, on a simulated board, arm and hand\n"
      "  inkwell info                                 shows the connected arm and its state\n"
      "  inkwell parameters set wall_stiffness_N_per_m=600 wall_damping_Ns_per_m=3\n"
      "  inkwell experiment wall --virtual --out results\n"
      "\n"
      "The window shows the arm in its box, with the signals over time below. The panes on the right are Tuning, "
      "Guides,\n"
      "Recording, Faults and Log. F1 lists the keys; Escape, F12 and STOP switch the force off. Sizes, theme and "
      "layouts\n"
      "are saved to inkwell/window.toml of $XDG_CONFIG_HOME (~/.config), unless --forget-settings is given.\n"
      "\n"
      "`inkwell COMMAND --help` describes a command. The options above may precede or follow the command.\n"
      "Lengths are in meters, angles in radians, forces in newtons, times in seconds of board time. Names of\n"
      "parameters and signals end in their unit.\n"
      "Exit code: 0 success, 1 the device or the command failed (the reason is on standard error), 2 wrong usage.");
}

}  // namespace

int run(int argument_count, char** arguments) {
  CLI::App program(
      "Companion of an Inkwell haptic arm: a robot arm with a stylus that you hold and motors that let you feel walls\n"
      "Without a command it opens the window. The commands provide the same functions for scripts and terminals.",
      "inkwell");
  describe(program);
  program.require_subcommand(0, 1);
  program.fallthrough();  // device options may also follow the command

  DeviceOptions options;
  Action action;
  options.add_to(program);
  const CommandContext context{program, options, action, add_window_options(program, options, action)};
#define X(name) add_##name##_command(context);
  INKWELL_COMMANDS(X)
#undef X
  add_moved_commands(program);

  return run_program(program, argument_count, arguments, action, [&program] {
    // CLI11 ignores commands after "--", so the program would open the window.
    if (program.get_subcommands().empty() && !program.remaining().empty())
      throw UsageError(
          "\"--\" is not allowed before the command. Omit it, or put it after the command of `inkwell run`.");
    refuse_window_options_in_vain(program);
  });
}

}  // namespace inkwell::command_line
