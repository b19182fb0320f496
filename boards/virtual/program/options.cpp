#include "options.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include <debugger/symbols.hpp>
#include <installation/places.hpp>
#include <program/requests.hpp>
#include <protocol/image_identity.hpp>

#include "log.hpp"

namespace inkwell::virtual_board {
namespace {

/// Command line options as text, before they are checked.
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
    "Runs the ELF of an STM32F405 on a board made of software: the chip, bridges, motors and sensors, an arm and a\n"
    "hand. Its USB device is exported by the USB/IP protocol; a control "
    "socket moves the hand, presses buttons, runs\n"
    "stops the time, and reports quantities that a real board cannot measure.\n"
    "A PORT is a TCP port of 127.0.0.1, which every user of this computer can use (0: any free one), or unix:PATH, a\n"
    "Unix socket of mode 0600. `unix:` alone is a socket in a new private folder, which is removed at the end.\n"
    "When it is ready it prints one line: ready usbip=PORT control=PORT, and gdb=PORT and uartN=PORT if asked for.\n"
    "Its log goes to stderr.";

void add_files_and_ports(CLI::App& app, Given& given) {
  app.add_option("--elf", given.options.elf,
                 "firmware to run, as it would be flashed; may be left out with --flash, to run what is in that file")
      ->type_name("FILE");
  app.add_option("--board", given.board,
                 "the board around the chip: " + board::names_of_boards() +
                     ". Unless given, the one that the ELF is for; firmware\nof others: " +
                     std::string(board::default_board.name))
      ->type_name("NAME");
  app.add_option("--arm", given.options.arm, "arm description; the Omni unless given")->type_name("FILE");
  app.add_option("--flash", given.options.flash,
                 "the chip's flash is kept in this file from run to run, which is made if it is not there; --elf "
                 "replaces the\nsectors that it needs, and what the firmware has stored elsewhere stays")
      ->type_name("FILE");
  app.add_option("--serial", given.serial_number,
                 "serial number, up to 24 hexadecimal digits. Unless given, one that --seed makes; without that one\n"
                 "for the file of --flash, else for the port of --usbip, else for this run")
      ->type_name("NUMBER");
  app.add_option("--usbip", given.usbip, "where the USB/IP server listens")->type_name("PORT")->capture_default_str();
  app.add_option("--control", given.control, "where the control socket listens")
      ->type_name("PORT")
      ->capture_default_str();
  given.gdb_option =
      app.add_option("--gdb", given.gdb,
                     "where GDB may connect (target remote :PORT, or target remote PATH); --mode is exact")
          ->type_name("PORT");
}

void add_chip(CLI::App& app, Given& given) {
  given.mode_option = app.add_option("--mode", given.mode,
                                     "exact: interrupts come at any instruction; fast: between blocks of instructions")
                          ->check(CLI::IsMember({"exact", "fast"}).description(""))
                          ->type_name("exact|fast")
                          ->capture_default_str();
  app.add_option("--pricing", given.pricing,
                 "what instructions cost where the sources leave a choice (docs/cycles.md); deadlines are judged by\n"
                 "the conservative figures")
      ->check(CLI::IsMember({"likely", "conservative"}).description(""))
      ->type_name("likely|conservative")
      ->capture_default_str();
  app.add_option("--crystal", given.options.crystal_Hz,
                 "frequency of the crystal at the pins OSC, 4 to 26 MHz; the board's unless given")
      ->check(CLI::Range(4'000'000, 26'000'000).description(""))
      ->type_name("HZ");
  app.add_option(
         "--crystal-ppm", given.options.crystal_ppm,
         "it swings faster than that by so many parts in a million; negative: slower. USB bears 2500 (USB 2.0,\n"
         "section 7.1.11), a crystal for it has 50")
      ->check(CLI::Range(-10'000, 10'000).description(""))
      ->type_name("N")
      ->capture_default_str();
  app.add_option(
         "--lsi", given.options.low_speed_internal_Hz,
         "frequency of the low-speed internal oscillator, which the watchdog runs from; each chip has its own,\n"
         "from 17 to 47 kHz")
      ->check(CLI::Range(17'000, 47'000).description(""))
      ->type_name("HZ")
      ->capture_default_str();
  app.add_flag(
      "--from-boot-loader", given.options.from_boot_loader,
      "the boot loader in the chip starts the firmware, by its command Go, and leaves PLL, vector table and the clock\n"
      "of CCM otherwise than a reset does");
  app.add_option("--flash-times", given.flash_times, "how long the flash takes to erase and program, by the data sheet")
      ->check(CLI::IsMember({"typical", "maximum"}).description(""))
      ->type_name("typical|maximum")
      ->capture_default_str();
  app.add_flag(
      "--boot0", given.options.boot_loader,
      "the button BOOT0 is held while the power comes on: the chip's boot loader runs, and waits on USB for a\n"
      "new firmware");
  app.add_option("--brown-out", given.options.brown_out_level,
                 "brown-out level in the chip's option bytes: 0 is off, as in a new chip; 3 is what the board wants")
      ->check(CLI::Range(0, 3).description(""))
      ->type_name("LEVEL")
      ->capture_default_str();
}

void add_time_and_seed(CLI::App& app, Given& given) {
  app.add_option("--host-clock-ppm", given.options.host_clock_ppm,
                 "the USB host's clock is faster than board time by so many parts in a million: its start of frame\n"
                 "comes at its own millisecond; negative: slower (USB 2.0, section 7.1.11, bears 500)")
      ->check(CLI::Range(-500.0, 500.0).description(""))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--real-time", given.options.real_time, "keep board time from running ahead of the clock on the wall");
  app.add_option("--clock", given.options.clock,
                 "file that all boards with the same --clock share: none gets more than a millisecond ahead of another")
      ->type_name("FILE");
  app.add_flag("--lock-step", given.options.lock_step,
               "board time passes only while each program on USB waits for a report or a control transfer. A program\n"
               "that asks for one report at a time then misses none and answers in time");
  given.seed_option =
      app.add_option("--seed", given.options.seed, "of all noise; the same seed and commands give the same run")
          ->type_name("N")
          ->capture_default_str();
  given.seconds_option = app.add_option("--seconds", given.seconds, "end after this much board time")
                             ->check(CLI::PositiveNumber.description(""))
                             ->type_name("T");
}

void add_instruments(CLI::App& app, Given& given) {
  app.add_option("--uart", given.uarts,
                 "where a UART leads, both ways: usart1=stdio is this terminal, "
                 "usart1=PORT a TCP port or Unix socket,\n"
                 "usart1=PATH a terminal of its own under that name; usart1 to usart3, uart4, uart5, usart6")
      ->type_name("UART=PLACE")
      ->allow_extra_args(false);
  app.add_option("--vcd", given.options.waveform,
                 "write levels of pins and the running exception to this file, for GTKWave")
      ->type_name("FILE");
  app.add_option("--vcd-pins", given.pins, "only these pins, such as PA8,PC6 (default: all)")
      ->delimiter(',')
      ->type_name("PINS");
  given.profile_option = app.add_option("--profile", given.profile,
                                        "at the end, write the instructions of the longest interrupt and their cycles "
                                        "to this file\n(tools/flame-graph draws it); --mode is exact")
                             ->type_name("FILE");
}

void add_faults(CLI::App& app, Given& given) {
  app.add_option(
         "--inject", given.injections,
         "a fault that comes at a board time in seconds and lasts so long, as in encoder_lost_counts:2=0.05@1.5+0.2;\n"
         "without @ from the start, without + for ever; below are all. May be given several times")
      ->type_name("FAULT")
      ->allow_extra_args(false);
  app.add_option("--inject-from", given.injection_script,
                 "a file with one such fault a line; what follows a # is a comment")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
}

void add_start_and_end(CLI::App& app, Given& given) {
  app.add_flag("--paused", given.options.paused, "start with board time standing still until a client runs it");
  app.add_flag(
      "--strict", given.options.strict,
      "end, with exit code 4, when the firmware first does what silicon would not bear; without it such things\n"
      "are logged and listed at the end");
}

std::string footer() {
  return "Exit codes: 0 ended as asked, 1 cannot run (the reason is on stderr), 2 wrong options, 3 the processor was\n"
         "locked up at the end of --seconds, 4 a broken rule (--strict); firmware "
         "that ends by semihosting passes its own\n"
         "exit code on.\n"
         "\n"
         "Board time waits for the program that uses the device on USB when it owes the next request of a "
         "stream, until\n"
         "it asks for more or is gone. So a busy computer, or a debugger that stops that program, loses no data.\n"
         "With --real-time, or where several programs use it, it waits for 3 s of the clock on the wall and passes "
         "on.\n"
         "\n"
         "Faults that can be put in, with what they are put into and the amount; its range, and what it is "
         "unless given:\n" +
         explain_injections() +
         "\n"
         "Control socket: one JSON object a line each way, such as "
         "{\"command\":\"run\",\"for_s\":0.5}. The commands with\n"
         "their keys; lengths in metres, angles in radians, times in seconds of board time:\n" +
         explain_commands();
}

/// Returns the name of the board for which the firmware in the flash file is built; empty if the file contains no
/// firmware of this project.
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
  log_line((given.board.empty() ? (runs_flash ? given.options.flash : given.options.elf).string() + " is for the board "
                                : "--board: ") +
           name + ", which is not known here; known are " + board::names_of_boards() + ".");
  return false;
}

/// Prints a sentence on stderr and returns false on errors.
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

/// Prints a sentence on stderr and returns false on errors.
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

/// Converts the text to options. Prints a sentence on stderr and returns false on errors.
bool take_over(Given& given) {
  if (*given.gdb_option || *given.profile_option) {
    if (*given.mode_option && given.mode != "exact") {
      log_line("--gdb and --profile look at every instruction; leave --mode fast out.");
      return false;
    }
    given.mode = "exact";
  }
  if (given.options.elf.empty() && given.options.flash.empty()) {
    log_line("there is nothing to run. Give a firmware with --elf, or a flash that holds one with --flash.");
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
    for (Injection& injection : parse_injections(text, *given.options.board))
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
