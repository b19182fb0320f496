// Requests a command through the window's DeviceDesk. The destructor of DeviceDesk sends the command.
// Usage: window_ending COMMAND exit|wait
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "host/client/device/address.hpp"
#include "host/companion/window/device_desk/device_desk.hpp"

namespace {

using namespace inkwell;
using protocol::Command;

template <class Condition>
void wait_until(window::DeviceDesk& desk, Condition condition) {
  while (!condition(desk.refresh())) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void carry_out(window::DeviceDesk& desk, const std::string& command) {
  auto& session = desk.session();
  if (command == "stop") session.send(Command::stop);
  if (command == "disable") {
    session.send(Command::enable_force);
    wait_until(desk, [](const auto& view) { return protocol::force_is_on(view.state()); });
    session.send(Command::disable_force);
  }
  if (command == "clear") session.send(Command::clear_fault);
  if (command == "set") session.set_parameters({{protocol::Parameter::wall_stiffness_N_per_m, 777.0f}});
  if (command == "store") session.store_parameters();
}

}  // namespace

int main(int, char** arguments) {
  const std::string command = arguments[1], ending = arguments[2];
  {
    window::DeviceDesk desk([] { return device::find_arms(device::parse_address(std::getenv("INKWELL_DEVICE"))); }, "");
    wait_until(desk, [](const auto& view) { return view.connected() && view.pose; });
    carry_out(desk, command);
  }
  std::puts("returned");
  std::fflush(stdout);
  if (ending == "wait") pause();
}
