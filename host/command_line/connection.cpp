#include "connection.hpp"

#include <arms/description.hpp>

namespace inkwell::command_line {

void DeviceOptions::add_to(CLI::App& app) {
  auto* is_virtual_flag = app.add_flag("--virtual", is_virtual, "Start a virtual board (a simulation) and use its arm");
  const char* group = "Virtual board (with --virtual)";
  app.add_option("--elf", elf, "Firmware that it runs; the one that belongs to this program unless given")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--arm", arm, "Arm description (TOML) that it simulates; the firmware gets its parameters")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--flash", flash, "File of its flash, made if missing: keeps what is stored; --arm is sent over that")
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

device::VirtualBoardOptions DeviceOptions::virtual_board(device::SimulationMode default_mode, BoardPace pace) const {
  device::VirtualBoardOptions board;
  board.elf = elf;
  board.arm = arm;
  board.flash = flash;
  board.mode = mode.empty()      ? default_mode
               : mode == "exact" ? device::SimulationMode::exact
                                 : device::SimulationMode::fast;
  board.seed = seed;
  board.real_time = real_time || pace == BoardPace::real_time;
  board.paused = pace == BoardPace::as_asked;
  board.strict = is_strict;
  return board;
}

device::Address DeviceOptions::address() const {
  if (is_virtual) return {.kind = device::Address::Kind::own_board, .arm = arm};
  if (usbip.empty()) return {.kind = device::Address::Kind::usb, .serial_number = serial_number};
  try {
    return device::parse_server(usbip);
  } catch (const device::BadAddress& error) {
    throw UsageError(error.what());
  }
}

device::OpenArm connect(const DeviceOptions& options, BoardPace pace, device::SimulationMode default_mode) {
  return device::open_arm(options.address(), options.virtual_board(default_mode, pace));
}

std::string arm_name(const DeviceOptions& options) {
  return options.arm.empty() ? std::string() : arms::read(options.arm).name;
}

}  // namespace inkwell::command_line
