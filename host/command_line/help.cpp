#include "help.hpp"

#include <memory>

#include <fmt/format.h>

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

void add_examples(CLI::App& command, const std::string& examples) {
  command.footer(fmt::format(
      "Examples:\n{}\n\n"
      "Which arm is meant: the one on USB unless told otherwise by --virtual, --usbip HOST:PORT or --serial NUMBER;\n"
      "--json gives output for programs. `inkwell --help` explains these and the exit codes.",
      indented(examples)));
}

}  // namespace inkwell::command_line
