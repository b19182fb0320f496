#include "host/client/command_line/wrong_value.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "host/client/device/parameter_file.hpp"

namespace inkwell::command_line {
namespace {

struct GivenOption {
  const CLI::Option* option;
  std::string command;
};

template <class Which>
std::optional<GivenOption> find_option(const CLI::App& app, const std::string& words, Which which) {
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; }))
    if (which(*option)) return GivenOption{option, words};
  for (const CLI::App* command : app.get_subcommands())
    if (auto found = find_option(*command, fmt::format("{} {}", words, command->get_name()), which)) return found;
  return std::nullopt;
}

std::string name_of(const CLI::Option& option) {
  std::string name = option.get_name();
  if (option.get_positional())
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

/// Returns the message for an invalid number.
std::string of_conversion(const GivenOption& given) {
  const auto is_number = [](const std::string& text) { return device::parse_number(text).has_value(); };
  const auto& values = given.option->results();
  const std::string name = name_of(*given.option), help = fmt::format("`{} --help` describes it.", given.command);
  if (given.option->get_items_expected_max() == 0)
    return fmt::format("{} accepts no value, but got {}. Omit the value; {}", name, CLI::detail::join(values, " "),
                       help);
  // CLI11 does not report which value is wrong.
  const auto no_number = std::ranges::find_if_not(values, is_number);
  if (no_number != values.end())
    return fmt::format("{} is not a number for {}. Give a number such as 12; {}", *no_number, name, help);
  return fmt::format("{} is not valid for {}. Give a whole number that is not negative, such as 12; {}",
                     CLI::detail::join(values, " "), name, help);
}

/// Handles a CLI11 text such as "--seconds: 1 required SECONDS missing".
std::optional<std::string> of_missing_value(const CLI::App& program, std::string_view raw) {
  if (!raw.ends_with(" missing") || raw.find(" required ") == std::string_view::npos) return std::nullopt;
  const std::string name(raw.substr(0, raw.find(':')));
  const auto given =
      find_option(program, program.get_name(), [&](const auto& option) { return option.get_name() == name; });
  if (!given) return std::nullopt;
  return fmt::format("The value of {} is missing. Give it after the option; `{} --help` describes it.",
                     name_of(*given->option), given->command);
}

}  // namespace

std::string sentence_of(const CLI::App& program, const CLI::ParseError& error) {
  std::string raw = error.what();
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const auto given = find_option(program, program.get_name(), [&](const CLI::Option& option) {
      return option.count() > 0 && raw == CLI::ConversionError(option.get_name(), option.results()).what();
    });
    if (given) return of_conversion(*given);
  }
  if (const auto sentence = of_missing_value(program, raw)) return *sentence;
  if (raw.ends_with('.')) return raw;  // a validator of this program has already written the sentence
  return fmt::format("{}\nRun with --help for more information.", raw);
}

}  // namespace inkwell::command_line
