#include "boards/virtual/program/options.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "boards/stm32f405/debugger/symbols.hpp"
#include "boards/virtual/program/requests.hpp"
#include "host/client/installation/installed_paths.hpp"
#include "host/client/local/text_file.hpp"
#include "protocol/image_identity.hpp"

#include "boards/virtual/program/log.hpp"

namespace inkwell::virtual_board {
namespace {

/// Unchecked text of the command line options.
struct Given {
  Options options;
  std::string usbip = "0", control = "0", gdb;
  std::string board, serial_number, mode = "fast", pricing = "likely", flash_times = "typical";
  double seconds = 0.0;
  std::vector<std::string> uarts, pins, injections;
  std::string profile, injection_script;
  CLI::Option *gdb_option = nullptr, *seed_option = nullptr, *mode_option = nullptr, *seconds_option = nullptr,
              *profile_option = nullptr;
};

constexpr const char* description =
    "Runs an ELF file for the STM32F405 on a simulated board with chip, bridges, motors, sensors, arm and hand. The\n"
    "USB device is exported through USB/IP. The control socket moves the hand, presses buttons, starts and stops\n"
    "board time, and returns quantities that a real board cannot measure.\n"
    "PORT is a TCP port of 127.0.0.1, which every user of this computer can use (0: any free port), or unix:PATH, a\n"
    "Unix socket with mode 0600. `unix:` alone creates a socket in a new private folder, which is removed at exit.\n"
    "When the board is ready, one line is printed: ready usbip=PORT control=PORT, with gdb=PORT and uartN=PORT if\n"
    "these options are used. The log is printed on stderr.";

void add_files_and_ports(CLI::App& app, Given& given) {
  app.add_option("--elf", given.options.elf,
                 "Firmware image (ELF) to run. Not needed if the file of --flash contains a firmware")
      ->type_name("FILE");
  app.add_option("--board", given.board,
                 "Driver board to simulate: " + board::names_of_boards() +
                     ". Default: the board for which the\nfirmware is built, or " +
                     std::string(board::default_board.name) + " if the firmware does not name a board")
      ->type_name("NAME");
  app.add_option("--arm", given.options.arm, "Arm description (TOML). Default: the Omni")->type_name("FILE");
  app.add_option("--flash", given.options.flash,
                 "File for the flash memory, created if missing. --elf replaces only the flash sectors that the image\n"
                 "needs; other sectors keep their contents")
      ->type_name("FILE");
  app.add_option("--serial", given.serial_number,
                 "Serial number, up to 24 hexadecimal digits. Default: derived from --seed if set, else from the file\n"
                 "of --flash, else from the port of --usbip, else from the process")
      ->type_name("NUMBER");
  app.add_option("--usbip", given.usbip, "Address of the USB/IP server")->type_name("PORT")->capture_default_str();
  app.add_option("--control", given.control, "Address of the control socket")->type_name("PORT")->capture_default_str();
  given.gdb_option = app.add_option("--gdb", given.gdb,
                                    "Address for GDB (target remote :PORT, or target remote PATH). Sets --mode exact")
                         ->type_name("PORT");
}

void add_chip(CLI::App& app, Given& given) {
  given.mode_option = app.add_option("--mode", given.mode,
                                     "exact: interrupts at any instruction; fast: interrupts only between instruction "
                                     "blocks")
                          ->check(CLI::IsMember({"exact", "fast"}).description(""))
                          ->type_name("exact|fast")
                          ->capture_default_str();
  app.add_option("--pricing", given.pricing,
                 "Cycle costs of instructions where the sources allow two values (docs/cycles.md). Use conservative\n"
                 "costs to check deadlines")
      ->check(CLI::IsMember({"likely", "conservative"}).description(""))
      ->type_name("likely|conservative")
      ->capture_default_str();
  app.add_option("--crystal", given.options.crystal_Hz,
                 "Frequency of the crystal at the OSC pins, 4 to 26 MHz. Default: the crystal of the board")
      ->check(CLI::Range(4'000'000, 26'000'000).description(""))
      ->type_name("HZ");
  app.add_option(
         "--crystal-ppm", given.options.crystal_ppm,
         "Deviation of the crystal from --crystal in parts per million, positive if fast. USB allows 2500 (USB 2.0,\n"
         "section 7.1.11); typical crystals have 50")
      ->check(CLI::Range(-10'000, 10'000).description(""))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--lsi", given.options.low_speed_internal_Hz,
                 "Frequency of the low-speed internal oscillator, which clocks the watchdog. It varies between chips,\n"
                 "from 17 to 47 kHz")
      ->check(CLI::Range(17'000, 47'000).description(""))
      ->type_name("HZ")
      ->capture_default_str();
  app.add_flag(
      "--from-boot-loader", given.options.from_boot_loader,
      "Start the firmware with the Go command of the chip's boot loader. PLL, vector table and CCM clock then\n"
      "differ from their reset state");
  app.add_option("--flash-times", given.flash_times, "Erase and program times of the flash in the data sheet")
      ->check(CLI::IsMember({"typical", "maximum"}).description(""))
      ->type_name("typical|maximum")
      ->capture_default_str();
  app.add_flag(
      "--boot0", given.options.boot_loader,
      "Simulate a pressed BOOT0 button at power-on: the chip's boot loader runs and waits on USB for new firmware");
  app.add_option("--brown-out", given.options.brown_out_level,
                 "Brown-out level in the option bytes: 0 is off, as in a new chip; 3 is the level for this board")
      ->check(CLI::Range(0, 3).description(""))
      ->type_name("LEVEL")
      ->capture_default_str();
}

void add_time_and_seed(CLI::App& app, Given& given) {
  app.add_option("--host-clock-ppm", given.options.host_clock_ppm,
                 "Deviation of the USB host's clock from board time in parts per million, positive if fast. USB\n"
                 "allows 500 (USB 2.0, section 7.1.11)")
      ->check(CLI::Range(-500.0, 500.0).description(""))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--real-time", given.options.real_time, "Run board time in real time");
  app.add_option("--clock", given.options.clock,
                 "File of a common clock. The times of boards with the same file differ by at most 1 ms")
      ->type_name("FILE");
  app.add_flag(
      "--lock-step", given.options.lock_step,
      "Let board time pass only while each program on USB waits for a report or a control transfer. A program\n"
      "that requests one report at a time then receives every report and answers in time");
  given.seed_option = app.add_option("--seed", given.options.seed,
                                     "Seed of all noise. The same seed and the same commands repeat a run")
                          ->type_name("N")
                          ->capture_default_str();
  given.seconds_option = app.add_option("--seconds", given.seconds, "Board time in seconds after which the board exits")
                             ->check(CLI::PositiveNumber.description(""))
                             ->type_name("T");
}

void add_instruments(CLI::App& app, Given& given) {
  app.add_option("--uart", given.uarts,
                 "Connect a UART (usart1 to usart3, uart4, uart5, usart6) in both directions: usart1=stdio to this\n"
                 "terminal, usart1=PORT to a TCP port or a Unix socket, usart1=PATH to a new pseudo-terminal at PATH")
      ->type_name("UART=TARGET")
      ->allow_extra_args(false);
  app.add_option("--vcd", given.options.waveform,
                 "File for pin levels and the running exception over time, for GTKWave")
      ->type_name("FILE");
  app.add_option("--vcd-pins", given.pins, "Pins for --vcd, such as PA8,PC6. Default: all pins")
      ->delimiter(',')
      ->type_name("PINS");
  given.profile_option = app.add_option("--profile", given.profile,
                                        "File for the instructions of the longest interrupt and their cycles, written "
                                        "at exit for\ntools/docs/flame-graph. Sets --mode exact")
                             ->type_name("FILE");
}

void add_faults(CLI::App& app, Given& given) {
  app.add_option(
         "--inject", given.injections,
         "Inject a fault (list below), such as encoder_lost_counts:2=0.05@1.5+0.2: at board time 1.5 s for 0.2 s.\n"
         "Without @, the fault starts at time 0; without +, it lasts indefinitely. Repeat the option for more faults")
      ->type_name("FAULT")
      ->allow_extra_args(false);
  app.add_option("--inject-from", given.injection_script,
                 "File with one fault per line, as for --inject. Text after a # is a comment")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
}

void add_start_and_end(CLI::App& app, Given& given) {
  app.add_flag("--paused", given.options.paused, "Stop board time at the start, until a client runs it");
  app.add_flag(
      "--strict", given.options.strict,
      "Exit with code 4 when the firmware first breaks a rule of the chip. Without --strict, broken rules are\n"
      "logged and listed at exit");
}

std::string footer() {
  return "Exit codes: 0 normal exit, 1 the board cannot run (the reason is printed on stderr), 2 invalid options,\n"
         "3 the processor was locked up at the end of --seconds, 4 the firmware broke a rule (--strict). If the\n"
         "firmware exits through semihosting, its exit code is used.\n"
         "\n"
         "While a program streams from the USB device, board time waits for the next request of the program, until\n"
         "the program sends the request or disconnects. A busy computer, or a debugger that stops the program,\n"
         "therefore loses no data. With --real-time, or if several programs use the device, board time waits for at\n"
         "most 3 s of real time.\n"
         "\n"
         "Injected faults, with position and unit of the amount, and at the end of the line its range and default:\n" +
         explain_injections() +
         "\n"
         "Control socket: one JSON object per line in both directions, such as {\"command\":\"run\",\"for_s\":0.5}.\n"
         "Commands and their keys, with lengths in meters, angles in radians, and times in seconds of board time:\n" +
         explain_commands();
}

/// Returns the board name of the firmware in a flash file, or an empty name if the file contains no firmware of this
/// project.
std::string board_in_flash(const std::filesystem::path& file) {
  std::ifstream flash(file, std::ios::binary);
  protocol::ImageIdentity identity{};
  flash.seekg(protocol::image_identity_offset);
  flash.read(reinterpret_cast<char*>(&identity), sizeof identity);
  return flash && identity.is_there() ? std::string(identity.board_name()) : std::string();
}

bool take_board(Given& given) {
  const bool runs_flash = given.options.elf.empty();
  const std::string name = !given.board.empty() ? given.board
                           : runs_flash         ? board_in_flash(given.options.flash)
                                                : text_in_elf(given.options.elf, "inkwell_board_name");
  if (name.empty()) return true;
  given.options.board = board::find_board(name);
  if (given.options.board != nullptr) return true;
  log_line((given.board.empty()
                ? (runs_flash ? given.options.flash : given.options.elf).string() + " is for the unknown board "
                : "--board: unknown board ") +
           name + ". Known boards: " + board::names_of_boards() + ".");
  return false;
}

/// On an error, prints a sentence on stderr and returns false.
bool take_ports(Given& given) {
  const auto read = [](const char* option, const std::string& text, PortOption& port) {
    try {
      port = PortOption::of(text);
    } catch (const std::invalid_argument& error) {
      std::cerr << "virtual-board: " << option << ": " << error.what() << "\n";
      return false;
    }
    return true;
  };
  return read("--usbip", given.usbip, given.options.usbip) && read("--control", given.control, given.options.control) &&
         (!*given.gdb_option || read("--gdb", given.gdb, given.options.gdb.emplace()));
}

/// On an error, prints a sentence on stderr and returns false.
bool take_serial_number(Given& given) {
  Options& options = given.options;
  try {
    options.unique_id = !given.serial_number.empty()      ? unique_id_of(given.serial_number)
                        : *given.seed_option              ? unique_id_of_seed(options.seed)
                        : !options.flash.empty()          ? unique_id_of_flash(options.flash)
                        : options.usbip.address.is_unix() ? unique_id_of_socket(options.usbip.address.path)
                        : options.usbip.address.port != 0 ? unique_id_of_port(options.usbip.address.port)
                                                          : unique_id_of_process();
  } catch (const std::invalid_argument& error) {
    log_line("--serial: " + std::string(error.what()));
    return false;
  }
  return true;
}

/// Converts the text to options. On an error, prints a sentence on stderr and returns false.
bool take_over(Given& given) {
  if (*given.gdb_option || *given.profile_option) {
    if (*given.mode_option && given.mode != "exact") {
      log_line("--gdb and --profile stop at every instruction. Omit --mode fast.");
      return false;
    }
    given.mode = "exact";
  }
  if (given.options.elf.empty() && given.options.flash.empty()) {
    log_line("no firmware to run. Set a firmware image with --elf, or a flash file with firmware with --flash.");
    return false;
  }
  if (!take_board(given) || !take_ports(given) || !take_serial_number(given)) return false;
  if (*given.profile_option) given.options.profile = given.profile;
  try {
    for (const std::string& name : given.pins) given.options.waveform_pins.push_back(PinName::of(name));
  } catch (const std::invalid_argument& error) {
    log_line("--vcd-pins: " + std::string(error.what()));
    return false;
  }
  try {
    for (const std::string& text : given.uarts) given.options.uarts.push_back(UartOption::of(text));
  } catch (const std::invalid_argument& error) {
    log_line("--uart: " + std::string(error.what()));
    return false;
  }
  try {
    for (const std::string& text : given.injections)
      given.options.injections.push_back(parse_injection(text, *given.options.board));
  } catch (const InvalidInjection& error) {
    log_line("--inject: " + std::string(error.what()));
    return false;
  }
  try {
    std::ifstream script(given.injection_script);
    const std::string text{std::istreambuf_iterator<char>(script), {}};
    for (Injection& injection : parse_injections(local::without_byte_order_mark(text), *given.options.board))
      given.options.injections.push_back(std::move(injection));
  } catch (const InvalidInjection& error) {
    log_line("--inject-from " + given.injection_script + ", " + error.what());
    return false;
  }
  given.options.mode = given.mode == "exact" ? Mode::exact : Mode::fast;
  given.options.pricing = given.pricing == "conservative" ? Pricing::conservative : Pricing::likely;
  given.options.slowest_flash = given.flash_times == "maximum";
  if (*given.seconds_option) given.options.seconds = given.seconds;
  return true;
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  Given given;
  given.options.arm = installation::default_arm();
  CLI::App app{description};
  app.name("virtual-board");
  app.get_formatter()->column_width(30);
  add_files_and_ports(app, given);
  add_chip(app, given);
  add_time_and_seed(app, given);
  add_instruments(app, given);
  add_faults(app, given);
  add_start_and_end(app, given);
  app.footer(footer());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  if (!take_over(given)) return {std::nullopt, 2};
  return {given.options, 0};
}

}  // namespace inkwell::virtual_board
