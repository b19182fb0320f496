#include "host/client/command_line/connection.hpp"

#include "boards/known/boards.hpp"

#include "host/client/command_line/help.hpp"
#include "host/client/device/arm_names.hpp"

namespace inkwell::command_line {

namespace {

CLI::Option* add_board_option(CLI::App& app, std::string& board) {
  const std::string names = inkwell::board::names_of_boards();
  return app.add_option("--board", board, "Driver board to simulate, with its firmware: " + names)->type_name("NAME");
}

CLI::Option* add_elf_option(CLI::App& app, std::filesystem::path& elf) {
  return app.add_option("--elf", elf, "Firmware image (ELF). Default: the image installed with this program")
      ->type_name("FILE");
}

CLI::Option* add_mode_option(CLI::App& app, std::string& mode) {
  return app
      .add_option("--mode", mode,
                  "exact: interrupts at any instruction; fast: interrupts only between instruction blocks")
      ->check(CLI::IsMember({"exact", "fast"}));
}

void add_json_flag(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "Print JSON for programs instead of text");
}

}  // namespace

void DeviceOptions::add_to(CLI::App& app) {
  auto* is_virtual_flag = app.add_flag("--virtual", is_virtual, "Start a virtual board (a simulation) and use its arm");
  const char* group = "Virtual board (with --virtual)";
  add_board_option(app, board)->needs(is_virtual_flag)->group(group);
  add_elf_option(app, elf)->needs(is_virtual_flag)->group(group);
  app.add_option("--arm", arm, "Arm description (TOML) to simulate; its parameters are sent to the firmware")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_option("--flash", flash,
                 "File for the flash memory, created if missing. --arm overrides its stored parameters")
      ->type_name("FILE")
      ->needs(is_virtual_flag)
      ->group(group);
  add_mode_option(app, mode)->needs(is_virtual_flag)->group(group);
  app.add_option("--seed", seed, "Seed of the noise and of the serial number")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->needs(is_virtual_flag)
      ->group(group);
  app.add_flag("--real-time", real_time, "Run in real time")->needs(is_virtual_flag)->group(group);
  auto* server =
      app.add_option("--usbip", usbip,
                     "HOST:PORT or unix:PATH of a USB/IP server, such as a running virtual board; not with\n--virtual")
          ->type_name("ADDRESS")
          ->check(not_empty())
          ->excludes(is_virtual_flag);
  app.add_option("--serial", serial_number,
                 "Use the arm with this serial number or name; not with --virtual or --usbip")
      ->type_name("NUMBER")
      ->check(not_empty())
      ->excludes(is_virtual_flag)
      ->excludes(server);
  app.add_flag("--take-over", take_over,
               "Take the arm over from the program that drives it; that program's force fades");
  add_json_flag(app, json);
}

void DeviceOptions::add_board_to(CLI::App& app) {
  const char* group = "Virtual boards";
  add_board_option(app, board)->group(group);
  add_elf_option(app, elf)->group(group);
  app.add_option("--arm", arm, "Arm description (TOML) to simulate")->type_name("FILE")->group(group);
  add_mode_option(app, mode)->group(group);
  add_json_flag(app, json);
}

device::VirtualBoardOptions DeviceOptions::virtual_board(device::SimulationMode default_mode, BoardPace pace) const {
  device::VirtualBoardOptions wanted;
  wanted.elf = elf;
  wanted.board = board;
  wanted.arm = arm;
  wanted.flash = flash;
  wanted.mode = mode.empty()      ? default_mode
                : mode == "exact" ? device::SimulationMode::exact
                                  : device::SimulationMode::fast;
  wanted.seed = seed;
  wanted.real_time = real_time || pace == BoardPace::real_time;
  wanted.paused = pace == BoardPace::as_asked;
  wanted.lock_step = pace == BoardPace::lock_step;
  wanted.strict = is_strict;
  return wanted;
}

device::Address DeviceOptions::address() const {
  if (is_virtual) return {.kind = device::Address::Kind::own_board, .arm = arm};
  try {
    return usbip.empty() ? device::named_address(serial_number) : device::parse_server(usbip);
  } catch (const device::BadAddress& error) {
    throw UsageError(error.what());
  }
}

device::OpenArm connect(const DeviceOptions& options, BoardPace pace, device::SimulationMode default_mode) {
  auto arm = device::open_arm(options.address(), options.virtual_board(default_mode, pace),
                              pace == BoardPace::lock_step ? &device::one_thread() : nullptr);
  if (options.take_over) arm.device->take_over();
  return arm;
}

}  // namespace inkwell::command_line
