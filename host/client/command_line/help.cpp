#include "host/client/command_line/help.hpp"

#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/client/device/nearest_name.hpp"
#include "host/client/device/parameter_file.hpp"

namespace inkwell::command_line {
namespace {

constexpr std::size_t name_width = 32;

class HelpStyle final : public CLI::Formatter {
 public:
  HelpStyle() { column_width_ = name_width; }

 private:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return {};
    std::string text;
    const std::string type = option->get_type_name();
    const auto choices = type.find('{');
    if (choices != std::string::npos)
      text = " " + type.substr(choices);
    else if (!option->get_positional())
      text = " " + type.substr(0, type.find(':'));
    if (!option->get_default_str().empty()) text += fmt::format(" ({})", option->get_default_str());
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    return text;
  }

  std::string make_description(const CLI::App* app) const override { return app->get_description() + "\n\n"; }

  std::string make_subcommand(const CLI::App* command) const override {
    const std::string description = command->get_description();
    return fmt::format("  {:<{}}{}\n", command->get_name(), name_width - 2,
                       description.substr(0, description.find('\n')));
  }
};

std::string indented(const std::string& lines) {
  std::string text = "  ";
  for (const char c : lines) {
    text += c;
    if (c == '\n') text += "  ";
  }
  return text;
}

}  // namespace

void set_help_style(CLI::App& program) { program.formatter(std::make_shared<HelpStyle>()); }

namespace {

template <class Fits>
CLI::Validator number_that(Fits fits, std::string what) {
  return CLI::Validator(
      [fits, what = std::move(what)](const std::string& text) {
        const auto value = device::parse_number(text);
        return value && std::isfinite(*value) && fits(*value)
                   ? std::string()
                   : fmt::format("{} is not valid. Give a number that is {}.", text, what);
      },
      "");
}

}  // namespace

CLI::Validator zero_or_more() {
  return number_that([](float value) { return value >= 0; }, "0 or more");
}

CLI::Validator more_than_zero() {
  return number_that([](float value) { return value > 0; }, "more than 0");
}

CLI::Validator number_within(double low, double high) {
  return number_that([from = static_cast<float>(low),
                      to = static_cast<float>(high)](float value) { return value >= from && value <= to; },
                     fmt::format("from {} to {}", low, high));
}

CLI::Validator whole_number_within(int low, int high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        int value = 0;
        return CLI::detail::lexical_cast(text, value) && value >= low && value <= high
                   ? std::string()
                   : fmt::format("{} is not valid. Give a whole number from {} to {}.", text, low, high);
      },
      "");
}

CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& text) {
        return text.empty() ? std::string("The value is empty. Give a value, or omit the option.") : std::string();
      },
      "");
}

namespace {

/// A command or a subcommand.
struct Below {
  std::string_view name;
};

struct Innermost {
  const CLI::App* command;
  std::string words;  ///< "inkwell parameters"
};

Innermost innermost(const CLI::App& program) {
  Innermost found{&program, program.get_name()};
  for (auto given = program.get_subcommands(); !given.empty(); given = found.command->get_subcommands())
    found = {given.front(), fmt::format("{} {}", found.words, given.front()->get_name())};
  return found;
}

}  // namespace

std::optional<std::string> wrong_command(const CLI::App& program) {
  const auto [command, words] = innermost(program);
  std::vector<Below> below;
  for (const CLI::App* each : command->get_subcommands([](const CLI::App*) { return true; }))
    below.push_back({each->get_name()});
  const auto typed = program.remaining(true);
  const bool is_unknown = !typed.empty() && !typed.front().starts_with('-');
  const bool is_missing = typed.empty() && command->get_require_subcommand_min() > 0;
  if (below.empty() || (!is_unknown && !is_missing)) return std::nullopt;
  const std::string unknown = is_unknown ? fmt::format("There is no `{} {}`.{} ", words, typed.front(),
                                                       device::suggestion(below, typed.front()))
                                         : std::string();
  if (command == &program) return fmt::format("{}`{} --help` lists the commands.", unknown, words);
  std::vector<std::string_view> names;
  names.reserve(below.size());
  for (const Below& each : below) names.push_back(each.name);
  return fmt::format("{}Choose one of these: {} {}.", unknown, words, fmt::join(names, ", "));
}

void add_examples(CLI::App& command, const std::string& examples) {
  add_examples(
      command, examples,
      "The command uses the arm on USB; choose another arm with --virtual, --usbip HOST:PORT or --serial NUMBER.\n"
      "--json prints JSON for programs. `inkwell --help` describes these options and the exit codes.");
}

void add_examples(CLI::App& command, const std::string& examples, const std::string& hints) {
  command.footer(fmt::format("Examples:\n{}\n\n{}", indented(examples), hints));
}

}  // namespace inkwell::command_line
