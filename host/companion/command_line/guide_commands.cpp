#include "host/companion/command_line/guide_commands.hpp"

#include <fmt/format.h>
#include "host/client/command_line/help.hpp"

namespace inkwell::command_line {

std::vector<const guides::Offer*> guides_of(std::string_view group) {
  std::vector<const guides::Offer*> found;
  for (const auto* offer : guides::all_guides())
    if (offer->group == group) found.push_back(offer);
  return found;
}

void add_guides(
    CLI::App& command, const CommandContext& context, std::string_view group,
    const std::function<void(CLI::App& guide, const guides::Offer& offer, GuideOptions& options)>& add_options) {
  for (const auto* offer : guides_of(group)) {
    const auto options = std::make_shared<GuideOptions>();
    auto* guide = command.add_subcommand(std::string(offer->name), fmt::format("{}\n{}", offer->title, offer->help));
    if (add_options) add_options(*guide, *offer, *options);
    options->consent.add_to(*guide);
    add_examples(*guide, fmt::format("inkwell {0} {1}\ninkwell {0} {1} --virtual --yes --json", group, offer->name));
    guide->callback([context, options, offer] {
      context.action = [&device = context.device, options, offer] {
        return run_guides(device, options->consent, {offer}, options->choices);
      };
    });
  }
}

}  // namespace inkwell::command_line
