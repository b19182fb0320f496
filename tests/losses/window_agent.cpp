// Provides the window's device connection without a display, for losses_test.py. The window sends no force; a wall of
// the box produces the force.
#include <chrono>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "host/client/device/address.hpp"
#include "host/client/device/fault_text.hpp"
#include "host/client/device/open_arm.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"

#include "tests/losses/answer_commands.hpp"

namespace {

using namespace inkwell;
using namespace std::chrono_literals;

std::optional<window::DeviceDesk> desk;

std::string shown_position(const window::DeviceView& view) {
  return view.pose ? std::to_string(view.pose->position_m[0]) : "none";
}

[[noreturn]] void fail(const window::DeviceView& view, const std::string& sentence) {
  throw std::runtime_error(shown_position(view) + " " + sentence);
}

/// Throws the displayed message if the window shows no current pose.
const window::DeviceView& connected_view() {
  const auto& view = desk->refresh();
  const bool is_silent = view.status.message.find("silent") != std::string::npos;
  if (!view.connected() || !view.pose || is_silent) fail(view, view.status.message);
  return view;
}

/// Throws the displayed reason if this window has not switched the force on.
void require_force(const window::DeviceView& view) {
  const auto& driver = view.status.driver;
  if (driver && !driver->is_this_device) fail(view, device::driver_text(*driver));
  if (view.state() == protocol::State::fault) fail(view, device::fault_line(view.pose->fault));
  if (!protocol::force_is_on(view.state())) fail(view, std::string(info(view.state()).meaning));
}

/// Clears the fault and enables the force, as the window's two buttons do.
void enable() {
  constexpr int tries = 6'000;
  desk->session().send(protocol::Command::clear_fault);
  desk->session().send(protocol::Command::enable_force);
  for (int i = 0; i < tries; ++i) {
    const auto& view = desk->refresh();
    if (view.status.command_problem) fail(view, *view.status.command_problem);
    const bool drives = view.status.driver && view.status.driver->is_this_device;
    if (drives && view.pose && protocol::force_is_on(view.state())) return;
    std::this_thread::sleep_for(5ms);
  }
  require_force(connected_view());
}

void open(const std::string& address) {
  constexpr int tries = 6'000;
  desk.reset();
  desk.emplace([address] { return device::find_arms(device::parse_address(address)); }, "");
  for (int i = 0; i < tries && !desk->refresh().pose; ++i) std::this_thread::sleep_for(5ms);
  enable();
}

void carry_out(std::istringstream& words) {
  std::string name, address;
  words >> name;
  if (name == "open" && words >> address) {
    open(address);
  } else if (!desk) {
    throw std::runtime_error("none The window is closed.");
  } else if (name == "enable") {
    enable();
  } else if (name == "pose") {
    const auto position = shown_position(connected_view());
    std::cout << "ok " << position << std::endl;
    return;
  } else if (name == "push") {
    std::this_thread::sleep_for(30ms);
    require_force(connected_view());
  } else if (name == "close") {
    desk.reset();
  }
  std::cout << "ok" << std::endl;
}

}  // namespace

int main() { inkwell::tests::answer_commands(carry_out); }
