#include "host/companion/command_line/program.hpp"

#include <cstdio>
#include <exception>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include "host/client/device/address.hpp"
#include "protocol/plain_text.hpp"

#include "host/companion/command_line/commands.hpp"
#include "host/companion/command_line/help.hpp"
#include "host/companion/command_line/wrong_value.hpp"

namespace inkwell::command_line {
namespace {

constexpr int success = 0, failure = 1, wrong_usage = 2;

int complain(const std::exception& error, int exit_code) {
  fmt::print(stderr, "inkwell: {}\n", protocol::plain_lines(error.what()));
  return exit_code;
}

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
  const Place place{program, options, action, add_window_options(program, options, action)};
#define X(name) add_##name##_command(place);
  INKWELL_COMMANDS(X)
#undef X

  try {
    program.parse(argument_count, arguments);
    // After "--" CLI11 ignores a command, so the program would open the window.
    if (program.get_subcommands().empty() && !program.remaining().empty())
      throw UsageError(
          "\"--\" is not allowed before the command. Omit it, or put it after the command of `inkwell run`.");
    refuse_window_options_in_vain(program);
  } catch (const UsageError& error) {
    return complain(error, wrong_usage);
  } catch (const CLI::RequiredError& error) {
    return complain(UsageError(wrong_command(program).value_or(error.what())), wrong_usage);
  } catch (const CLI::ExtrasError& error) {
    const auto sentence = wrong_command(program);
    return complain(UsageError(sentence ? *sentence : sentence_of(program, error)), wrong_usage);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return complain(UsageError(sentence_of(program, error)), wrong_usage);
    program.exit(error);  // prints the help or the version
    return success;
  }
  try {
    return action();
  } catch (const UsageError& error) {
    return complain(error, wrong_usage);
  } catch (const device::SeveralArms& error) {
    return complain(device::NoDevice(fmt::format("{} Choose one with --serial NUMBER.", error.what())), failure);
  } catch (const std::exception& error) {
    return complain(error, failure);
  }
}

}  // namespace inkwell::command_line
