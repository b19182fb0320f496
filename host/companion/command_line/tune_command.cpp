#include <fmt/format.h>
#include "host/client/command_line/help.hpp"
#include "host/client/recording/writer.hpp"

#include "host/companion/command_line/guide_commands.hpp"

namespace inkwell::command_line {
namespace {

void add_loop_options(CLI::App& guide, guides::CurrentLoopOptions& loop) {
  guide
      .add_option_function<int>(
          "--motor", [&loop](int motor) { loop.motors = {motor}; }, "Motor to measure, 1 to 3. Default: all three")
      ->type_name("NUMBER")
      ->check(whole_number_within(1, 3));
  guide
      .add_option("--bandwidth", loop.bandwidth_Hz,
                  fmt::format("Bandwidth of the current loops, {} to {} Hz", guides::bandwidth_minimum_Hz,
                              guides::bandwidth_maximum_Hz))
      ->type_name("HZ")
      ->check(number_within(guides::bandwidth_minimum_Hz, guides::bandwidth_maximum_Hz))
      ->capture_default_str();
  guide
      .add_option_function<std::string>(
          "--out",
          [&loop](const std::string& file) {
            try {
              recording::check_can_be_created(file);
            } catch (const device::Error& error) {
              throw UsageError(error.what());
            }
            loop.pulses = file;
          },
          "New recording of all pulses (.h5 or .csv), with a mark for each pulse")
      ->type_name("FILE");
}

}  // namespace

void add_tune_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand("tune", "Guides that determine parameters by measurement");
  command->require_subcommand(1);
  add_examples(
      *command,
      "inkwell tune current-loop --out pulses.h5\ninkwell tune current-loop --motor 2 --bandwidth 1500 --yes --apply");
  add_guides(*command, context, "tune", [](CLI::App& guide, const guides::Offer& offer, GuideOptions& options) {
    if (&offer == &guides::current_loop_guide) add_loop_options(guide, options.choices.current_loop);
  });
}

}  // namespace inkwell::command_line
