#include "host/companion/command_line/program_arms.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/arm_names.hpp"
#include "host/client/local/output.hpp"

namespace inkwell::command_line {
namespace {

using device::NamedArm;

constexpr std::string_view default_names[] = {"left", "right", "third", "fourth"};

void print_arm(const device::OpenArm& arm, const std::string& name) {
  local::print_error("inkwell: the program uses the arm {}{} ({}){}.\n", name.empty() ? name : name + ", ",
                     arm.endpoint.serial_number, device::address_of(arm.endpoint),
                     arm.endpoint.is_virtual ? ", a simulation" : "");
  if (arm.board)
    local::print_error("inkwell: its window and hand: inkwell --usbip {} --control {}\n", arm.board->usbip().text(),
                       arm.board->control_socket().text());
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream words(text);
  for (std::string name; std::getline(words, name, ',');) names.push_back(name);
  return names;
}

/// Throws UsageError.
std::vector<std::string> names_from(const std::string& text, bool is_virtual) {
  std::size_t count = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (code != std::errc{} || end != text.data() + text.size()) return split_names(text);
  if (!is_virtual)
    throw UsageError("--arms with a number requires --virtual. Give the names of the arms, as in --arms left,right.");
  if (count < 1 || count > std::size(default_names))
    throw UsageError(fmt::format("--arms {} is not valid. Give 1 to {}, or names.", text, std::size(default_names)));
  return {std::begin(default_names), std::begin(default_names) + count};
}

/// Throws UsageError.
void check_names(const std::vector<std::string>& names) {
  std::vector<NamedArm> checked;
  for (const auto& name : names) {
    try {
      device::check_arm_name(name);
    } catch (const device::Error& error) {
      throw UsageError(fmt::format("--arms: {}", error.what()));
    }
    if (device::find_arm_name(checked, name) != nullptr)
      throw UsageError(fmt::format("--arms contains the name {} twice. Give each name once.", name));
    checked.push_back({name, {}, {}});
  }
  if (names.empty()) throw UsageError("--arms contains no name. Give names, as in --arms left,right.");
}

NamedArm known_arm(const std::string& name) {
  const auto known = device::read_arm_names();
  if (const auto* const bound = device::find_arm_name(known, name)) return *bound;
  throw device::NoDevice(
      fmt::format("There is no arm with the name {}. {} Bind the name with `inkwell arms bind {}`.", name,
                  known.empty() ? "No names are known." : "Known names: " + device::names_of(known) + ".", name));
}

/// Opens the arm, prints the arm and closes it again. `number` is 0 for the first arm.
device::OpenArm try_arm(DeviceOptions options, std::size_t number, NamedArm& entry) {
  if (!options.is_virtual) {
    entry.control = known_arm(entry.name).control;
    options.serial_number = entry.name;
  }
  options.seed += number;  // boards with different seeds have different serial numbers
  auto arm = connect(options, BoardPace::real_time);
  print_arm(arm, entry.name);
  entry.address = device::address_of(arm.endpoint);
  if (arm.board) entry.control = arm.board->control_socket().text();
  arm.device.reset();  // from now on the program uses the arm
  return arm;
}

ProgramArms open_one_arm(const DeviceOptions& options) {
  ProgramArms arms;
  auto arm = connect(options, BoardPace::real_time);
  print_arm(arm, {});
  arm.device.reset();  // from now on the program uses the arm
  setenv("INKWELL_DEVICE", device::address_of(arm.endpoint).c_str(), 1);
  if (options.is_virtual) setenv("INKWELL_ARMS", "", 1);  // a trial in simulation must not move a real arm
  arms.boards.push_back(std::move(arm));
  return arms;
}

}  // namespace

ProgramArms open_program_arms(const DeviceOptions& options, const std::string& names_text) {
  if (names_text.empty()) return open_one_arm(options);
  if (!options.usbip.empty() || !options.serial_number.empty())
    throw UsageError("--arms selects the arms by name. Omit --serial and --usbip.");
  if (!options.flash.empty()) throw UsageError("--flash is the memory of one board. Omit --flash, or omit --arms.");
  const auto names = names_from(names_text, options.is_virtual);
  check_names(names);
  ProgramArms arms;
  std::vector<NamedArm> entries;
  for (const auto& name : names) {
    NamedArm entry{name, {}, {}};
    auto arm = try_arm(options, entries.size(), entry);
    const auto& number = arm.endpoint.serial_number;
    if (std::ranges::any_of(arms.boards, [&](const auto& other) { return other.endpoint.serial_number == number; }))
      throw device::Error(
          fmt::format("The name {} is a second name of the arm {}. Give names of different arms.", name, number));
    entries.push_back(std::move(entry));
    arms.boards.push_back(std::move(arm));
  }
  arms.names_folder.emplace(local::PrivateFolder::for_files());
  const auto file = arms.names_folder->path() / "arms.toml";
  device::write_arm_names(entries, file);
  setenv("INKWELL_ARMS", file.c_str(), 1);
  setenv("INKWELL_DEVICE", names.front().c_str(), 1);
  return arms;
}

}  // namespace inkwell::command_line
