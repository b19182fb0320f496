// Adds the guides of a group as subcommands.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/companion/command_line/commands.hpp"
#include "host/companion/command_line/guide_run.hpp"

namespace inkwell::command_line {

/// Values of a guide's command-line options.
struct GuideOptions {
  guides::Choices choices;
  Consent consent;
};

std::vector<const guides::Offer*> guides_of(std::string_view group);

/// Adds a subcommand for each guide of a group. `add_options` adds the options of one guide.
void add_guides(
    CLI::App& command, const CommandContext& context, std::string_view group,
    const std::function<void(CLI::App& guide, const guides::Offer& offer, GuideOptions& options)>& add_options = {});

}  // namespace inkwell::command_line
