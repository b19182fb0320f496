#include "host/client/device/arm_names.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "host/client/local/configuration_folder.hpp"
#include "host/client/local/replaced_file.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::device {
namespace {

constexpr std::size_t serial_number_digits = 24;
constexpr char remedy[] = "Correct the file, or write it with `inkwell arms bind`.";

bool is_same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The chip's unique identifier. No name looks like it, so a serial number is not looked up.
bool is_full_serial_number(std::string_view text) {
  return text.size() == serial_number_digits &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isxdigit(c) != 0; });
}

std::string quoted(const std::string& text) {
  std::ostringstream stream;
  stream << toml::value<std::string>(text);
  return stream.str();
}

NamedArm entry_of(const toml::table& table) {
  const auto text = [&](const char* key) {
    const auto* node = table.get(key);
    if (node != nullptr && !node->is_string()) throw Error(fmt::format("`{}` is not a text in quotes.", key));
    return table[key].value_or(std::string());
  };
  NamedArm arm{text("name"), text("address"), text("control")};
  check_arm_name(arm.name);
  if (arm.address.empty()) throw Error(fmt::format("The arm `{}` has no `address`. Give its serial number.", arm.name));
  parse_address(arm.address);
  if (!arm.control.empty()) parse_socket(arm.control);
  return arm;
}

}  // namespace

std::filesystem::path arm_names_file() {
  if (const char* file = std::getenv("INKWELL_ARMS"); file != nullptr) return file;
  const auto folder = local::configuration_folder();
  return folder.empty() ? folder : folder / "arms.toml";
}

void check_arm_name(std::string_view name) {
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ' ' || c == '-' || c == '_' || c == '.';
  };
  const bool is_valid = !name.empty() && name.size() <= longest_arm_name && name.front() != ' ' &&
                        name.front() != '-' && name.back() != ' ' && std::ranges::all_of(name, is_allowed);
  if (!is_valid)
    throw Error(fmt::format(
        "`{}` is not a name of an arm. Give up to {} letters, digits, spaces, `-`, `_` or `.`, such as left.", name,
        longest_arm_name));
  if (is_same_name(name, "virtual") || is_full_serial_number(name))
    throw Error(fmt::format("The name `{}` is an address. Choose another name, such as left.", name));
}

std::vector<NamedArm> parse_arm_names(std::string_view toml_text, const std::string& file_name) {
  toml::table document;
  try {
    document = toml::parse(toml_text, file_name);
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}, line {}: {}. {}", file_name, error.source().begin.line, error.description(), remedy));
  }
  for (const auto& [key, node] : document)
    if (key.str() != "arm" || !node.is_array_of_tables())
      throw Error(fmt::format("{}, line {}: `{}` is unknown. Write each arm as [[arm]] with `name` and `address`.",
                              file_name, node.source().begin.line, protocol::plain_text(key.str())));
  std::vector<NamedArm> arms;
  const toml::array* entries = document["arm"].as_array();
  if (entries == nullptr) return arms;
  for (const auto& node : *entries) {
    const auto line = node.source().begin.line;
    try {
      NamedArm arm = entry_of(*node.as_table());
      if (find_arm_name(arms, arm.name) != nullptr) throw Error(fmt::format("The name `{}` is bound twice.", arm.name));
      arms.push_back(std::move(arm));
    } catch (const Error& error) {
      throw Error(fmt::format("{}, line {}: {} {}", file_name, line, error.what(), remedy));
    }
  }
  return arms;
}

std::vector<NamedArm> read_arm_names(const std::filesystem::path& file) {
  std::error_code ignored;
  if (file.empty() || !std::filesystem::exists(file, ignored)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!std::filesystem::is_regular_file(file, ignored) || !stream || !(text << stream.rdbuf()).good())
    throw Error(fmt::format("The names of the arms, {}, cannot be read. Check your permission.", file.string()));
  return parse_arm_names(text.str(), file.string());
}

void write_arm_names(const std::vector<NamedArm>& arms, const std::filesystem::path& file) {
  std::string text = "# Names of the arms, in the order of their numbers. `inkwell arms` shows and changes them.\n";
  for (const auto& arm : arms) {
    text += fmt::format("\n[[arm]]\nname = {}\naddress = {}\n", quoted(arm.name), quoted(arm.address));
    if (!arm.control.empty()) text += fmt::format("control = {}\n", quoted(arm.control));
  }
  if (file.empty())
    throw Error("There is no file for the names of the arms. Set HOME, or set INKWELL_ARMS to the name of a file.");
  try {
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    local::replace_file(file, text);
  } catch (const std::system_error& error) {
    throw Error(fmt::format("The file {} cannot be written: {}. Check the folder, your permission and the free space.",
                            file.string(), error.code().message()));
  }
}

const NamedArm* find_arm_name(const std::vector<NamedArm>& arms, std::string_view name) {
  const auto found = std::ranges::find_if(arms, [&](const NamedArm& arm) { return is_same_name(arm.name, name); });
  return found == arms.end() ? nullptr : &*found;
}

std::string names_of(const std::vector<NamedArm>& arms) {
  std::string names;
  for (const auto& arm : arms) names += (names.empty() ? "" : ", ") + arm.name;
  return names;
}

std::string name_of_address(const std::vector<NamedArm>& arms, std::string_view address) {
  const auto found = std::ranges::find(arms, address, &NamedArm::address);
  return found == arms.end() ? std::string() : found->name;
}

Address named_address(std::string_view text) {
  Address address = parse_address(text);
  if (address.kind != Address::Kind::usb || text.empty() || is_full_serial_number(text)) return address;
  const auto arms = read_arm_names();
  const NamedArm* arm = find_arm_name(arms, text);
  if (arm == nullptr) return address;  // perhaps a serial number; find_arm() reports an unknown name
  address = parse_address(arm->address);
  address.name = arm->name;
  if (!arm->control.empty()) address.control = parse_socket(arm->control);
  return address;
}

}  // namespace inkwell::device
