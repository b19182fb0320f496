#include "connection.hpp"

#include <charconv>
#include <chrono>
#include <thread>

#include <fmt/format.h>

#include <arms/description.hpp>

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using device::Endpoint;

constexpr auto virtual_start_limit = 15s;
constexpr double virtual_start_limit_s = 2.0;  // of board time; the firmware shows itself after 0.1
constexpr double start_step_s = 0.01;

std::pair<std::string, std::uint16_t> split_address(const std::string& address) {
  const auto colon = address.rfind(':');
  const std::string digits = colon == std::string::npos ? address : address.substr(colon + 1);
  const std::string host = colon == std::string::npos || colon == 0 ? "127.0.0.1" : address.substr(0, colon);
  std::uint16_t port = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (code != std::errc{} || end != digits.data() + digits.size() || port == 0)
    throw UsageError(fmt::format("`{}` is no address. Give --usbip HOST:PORT, for example 127.0.0.1:3240.", address));
  return {host, port};
}

arms::Description read_arm(const std::filesystem::path& file) {
  try {
    return arms::read(file);
  } catch (const arms::DescriptionError& error) {
    throw device::Error(error.what());
  }
}

}  // namespace

void DeviceOptions::add_to(CLI::App& app) {
  auto* is_virtual_flag = app.add_flag("--virtual", is_virtual, "Start a virtual board (a simulation) and use its arm");
  const char* group = "Virtual board (with --virtual)";
  app.add_option("--elf", elf, "Firmware that it runs; the one built beside this program unless given")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--arm", arm, "Arm description (TOML) that it simulates; the firmware gets its parameters")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--mode", mode, "exact: interrupts come at any instruction; fast: between blocks of them, and quicker")
      ->check(CLI::IsMember({"exact", "fast"}))
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--seed", seed, "Seed of its noise and of its serial number")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_flag("--real-time", real_time, "Pace it to the clock on the wall")->needs(is_virtual_flag)->group(group);
  app.add_option("--usbip", usbip, "HOST:PORT of a USB/IP server, such as a running virtual board; not with --virtual")
      ->type_name("ADDRESS")
      ->excludes(is_virtual_flag);
  app.add_option("--serial", serial_number, "Use the arm with this serial number; not with --virtual")
      ->type_name("NUMBER")
      ->excludes(is_virtual_flag);
  app.add_flag("--json", json, "Write JSON for programs instead of text for people");
}

device::VirtualBoardOptions DeviceOptions::virtual_board(device::SimulationMode default_mode, BoardTime time) const {
  device::VirtualBoardOptions board;
  board.elf = elf;
  board.arm = arm;
  board.mode = mode.empty()      ? default_mode
               : mode == "exact" ? device::SimulationMode::exact
                                 : device::SimulationMode::fast;
  board.seed = seed;
  board.real_time = real_time || time == BoardTime::paced;
  board.paused = time == BoardTime::as_asked;
  board.strict = is_strict;
  return board;
}

std::vector<Endpoint> list_devices(const DeviceOptions& options, const device::VirtualBoard* board) {
  if (board != nullptr) {
    const auto endpoint = board->find();
    return endpoint ? std::vector{*endpoint} : std::vector<Endpoint>{};
  }
  if (!options.usbip.empty()) {
    const auto [host, port] = split_address(options.usbip);
    return device::find_usbip_devices(host, port);
  }
  auto endpoints = device::find_usb_devices();
  if (!options.serial_number.empty())
    std::erase_if(endpoints, [&](const Endpoint& endpoint) { return endpoint.serial_number != options.serial_number; });
  return endpoints;
}

Endpoint find_one(const DeviceOptions& options) {
  const auto endpoints = list_devices(options, nullptr);
  if (endpoints.empty() && !options.serial_number.empty())
    throw device::Error(
        fmt::format("No arm with the serial number {} is plugged in. `inkwell info` without --serial "
                    "shows the one that is.",
                    options.serial_number));
  if (endpoints.empty() && !options.usbip.empty())
    throw device::Error(
        fmt::format("The USB/IP server at {} exports no arm. Check that its board runs Inkwell's "
                    "firmware and its cable is in.",
                    options.usbip));
  if (endpoints.empty())
    throw device::Error("No arm was found on USB. Plug one in, or try a virtual one with --virtual.");
  if (endpoints.size() > 1) {
    std::string numbers;
    for (const auto& endpoint : endpoints) numbers += " " + endpoint.serial_number;
    throw device::Error(fmt::format("{} arms are plugged in. Choose one with --serial:{}.", endpoints.size(), numbers));
  }
  return endpoints.front();
}

std::string arm_name(const DeviceOptions& options) {
  return options.arm.empty() ? std::string() : read_arm(options.arm).name;
}

std::vector<device::ParameterChange> arm_parameters(const std::filesystem::path& file) {
  const auto arm = read_arm(file);
  std::vector<device::ParameterChange> changes;
  for (std::size_t i = 0; i < protocol::parameter_count; ++i)
    if (protocol::parameter_table[i].belongs_to_arm)
      changes.emplace_back(static_cast<protocol::Parameter>(i), arm.parameters.values[i]);
  return changes;
}

namespace {

/// Waits by the clock on the wall, or by the board's if its time passes as asked.
Endpoint wait_for_endpoint(const device::VirtualBoard& board, device::ControlClient* control) {
  const auto give_up_at = std::chrono::steady_clock::now() + virtual_start_limit;
  const auto too_late = [&] {
    return control != nullptr ? control->status().board_time_s > virtual_start_limit_s
                              : std::chrono::steady_clock::now() > give_up_at;
  };
  for (;;) {
    if (const auto endpoint = board.find()) return *endpoint;
    if (too_late())
      throw device::Error("The virtual board shows no USB device. Check that --elf names Inkwell's firmware.");
    if (control != nullptr)
      control->run(start_step_s);
    else
      std::this_thread::sleep_for(20ms);
  }
}

}  // namespace

Connection connect(const DeviceOptions& options, BoardTime time, device::SimulationMode default_mode) {
  Connection connection;
  if (!options.is_virtual) {
    const auto endpoint = find_one(options);
    connection.device = device::Device::open(endpoint);
    connection.is_simulation = endpoint.is_virtual;
    return connection;
  }
  std::vector<device::ParameterChange> arm;
  if (!options.arm.empty()) arm = arm_parameters(options.arm);
  connection.board = std::make_unique<device::VirtualBoard>(options.virtual_board(default_mode, time));
  if (time == BoardTime::as_asked) {
    connection.control.emplace(connection.board->control());
    connection.control->stand_by();
  }
  const auto endpoint = wait_for_endpoint(*connection.board, connection.control ? &*connection.control : nullptr);
  connection.device = device::Device::open(endpoint);
  connection.is_simulation = endpoint.is_virtual;
  if (!arm.empty()) connection.device->set_parameters(arm);
  return connection;
}

}  // namespace inkwell::command_line
