#include <array>
#include <cstdio>

#include <fmt/format.h>
#include "host/client/command_line/help.hpp"

#include "host/companion/command_line/guide_commands.hpp"

namespace inkwell::command_line {
namespace {

guides::AngleRange parse_range(const std::string& text) {
  guides::AngleRange range{};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &range.minimum_rad, &range.maximum_rad, &rest) != 2 ||
      !(range.minimum_rad < range.maximum_rad))
    throw UsageError(fmt::format(
        "`{}` is not a range. Give the angles of both stops in radians, lower first, for example -2.455:2.455.", text));
  return range;
}

struct CalibrateOptions : GuideOptions {
  std::string what = "all";
  std::string trust = "limits";
  std::array<std::string, 3> range;
};

int calibrate(const DeviceOptions& device, CalibrateOptions& options) {
  auto& choices = options.choices;
  choices.trust = options.trust == "limits" ? guides::StopsTrust::limits : guides::StopsTrust::encoders;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!options.range[axis].empty()) choices.potentiometers.range[axis] = parse_range(options.range[axis]);
  auto wanted = guides_of("calibrate");
  if (options.what != "all") std::erase_if(wanted, [&](const auto* offer) { return offer->name != options.what; });
  return run_guides(device, options.consent, wanted, choices);
}

}  // namespace

void add_calibrate_command(const CommandContext& context) {
  const auto options = std::make_shared<CalibrateOptions>();
  auto* command = context.program.add_subcommand(
      "calibrate",
      "Guides through the calibration of inkwell, joint stops and gimbal potentiometers\n"
      "You move the arm and press button 1; with --virtual a simulated hand does this.");
  std::vector<std::string> names;
  for (const auto* offer : guides_of("calibrate")) names.emplace_back(offer->name);
  names.emplace_back("all");
  command->add_option("WHAT", options->what, "Calibration to run")->check(CLI::IsMember(names))->capture_default_str();
  command->add_option("--trust", options->trust, "Values to trust if a stop is not at the angle in the arm description")
      ->check(CLI::IsMember({"limits", "encoders"}))
      ->capture_default_str();
  const char* ranges[] = {"--yaw-range", "--pitch-range", "--roll-range"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    command->add_option(ranges[axis], options->range[axis], "Angles of both stops as MINIMUM:MAXIMUM, in radians")
        ->type_name("RANGE");
  command->add_flag("--quadratic", options->choices.potentiometers.quadratic,
                    "Also fit a quadratic term for the potentiometers, from a third point in the middle");
  options->consent.add_to(*command);
  add_examples(*command,
               "inkwell calibrate\n"
               "inkwell calibrate pots --roll-range -2.58:2.58 --apply\n"
               "inkwell calibrate all --virtual --yes --json");
  command->callback([context, options] {
    context.action = [&device = context.device, options] { return calibrate(device, *options); };
  });
}

}  // namespace inkwell::command_line
