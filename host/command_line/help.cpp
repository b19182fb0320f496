#include "help.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <device/parameter_file.hpp>

namespace inkwell::command_line {
namespace {

constexpr std::size_t name_width = 32;

class HelpStyle final : public CLI::Formatter {
 public:
  HelpStyle() { column_width_ = name_width; }

 private:
  /// "NAME=default", without the library's remarks about validators and about what needs or excludes what: the
  /// descriptions say it.
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

  /// In a list of commands the first line is enough.
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

CLI::Validator number_that(bool (*fits)(float), const char* what) {
  return CLI::Validator(
      [fits, what](const std::string& text) {
        const auto value = device::parse_number(text);
        return value && std::isfinite(*value) && fits(*value)
                   ? std::string()
                   : fmt::format("{} does not do. Give a number that is {}.", text, what);
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

CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& text) {
        return text.empty() ? std::string("An empty text does not do. Leave the option out, or give it its value.")
                            : std::string();
      },
      "");
}

std::optional<std::string> missing_command(const CLI::App& program) {
  const auto given = program.get_subcommands();
  if (given.empty() || !given.front()->get_subcommands().empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const CLI::App* each : given.front()->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(each->get_name());
  if (names.empty()) return std::nullopt;
  const std::string command = given.front()->get_name();
  const auto words = program.remaining(true);
  const std::string unknown = words.empty() ? "" : fmt::format("There is no `{} {}`. ", command, words.front());
  return fmt::format("{}Say which of these: inkwell {} {}.", unknown, command, fmt::join(names, ", "));
}

void add_examples(CLI::App& command, const std::string& examples) {
  command.footer(fmt::format(
      "Examples:\n{}\n\n"
      "Which arm is meant: the one on USB unless told otherwise by --virtual, --usbip HOST:PORT or --serial NUMBER;\n"
      "--json gives output for programs. `inkwell --help` explains these and the exit codes.",
      indented(examples)));
}

}  // namespace inkwell::command_line
