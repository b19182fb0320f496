#include "host/client/firmware_update/probe.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/client/device/child_program.hpp"
#include "protocol/plain_text.hpp"

namespace inkwell::firmware_update {
namespace {

constexpr char cannot_use[] =
    "openocd could not write the firmware: see above. Check that the probe is connected to SWDIO, SWCLK, NRST and "
    "ground, and that the board's power is on.";
constexpr char cannot_read[] =
    "openocd could not read the board's firmware: see above. Check that the probe is connected to SWDIO, SWCLK, NRST "
    "and ground, and that the board's power is on. For a chip whose flash cannot be read, add --yes. Nothing was "
    "changed.";
constexpr char not_verified[] =
    "openocd exited without a report that the firmware was verified, so the flash content is unknown. Check openocd's "
    "installation and settings, then try again.";

enum class HexRecord : std::uint8_t { data = 0, end = 1, upper_address = 4 };

void append_record(std::string& text, HexRecord kind, std::uint16_t address, std::span<const std::byte> bytes) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, ":{:02X}{:04X}{:02X}", bytes.size(), address, static_cast<unsigned>(kind));
  unsigned sum = static_cast<unsigned>(bytes.size()) + (address >> 8) + (address & 0xFFu) + static_cast<unsigned>(kind);
  for (const std::byte byte : bytes) {
    fmt::format_to(out, "{:02X}", std::to_integer<unsigned>(byte));
    sum += std::to_integer<unsigned>(byte);
  }
  fmt::format_to(out, "{:02X}\n", (0x100u - (sum & 0xFFu)) & 0xFFu);
}

void write_image_file(const Image& image, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << intel_hex(image);
  stream.close();
  if (!stream) throw device::Error(fmt::format("{} cannot be written. Free some space and try again.", file.string()));
}

/// Splits a stream of output into lines.
class Lines {
 public:
  explicit Lines(const std::function<void(const std::string&)>& on_line) : on_line_(on_line) {}
  void add(std::string_view piece) {
    for (const char c : piece) {
      if (c == '\n')
        end();
      else
        line_ += c;
    }
  }
  void end() {
    if (line_.empty()) return;
    while (line_.ends_with('\r')) line_.pop_back();
    on_line_(protocol::plain_text(line_));
    line_.clear();
  }

 private:
  const std::function<void(const std::string&)>& on_line_;
  std::string line_;
};

}  // namespace

bool is_interface_name(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string no_interface_name(std::string_view name) {
  return fmt::format(
      "`{}` is not a name of an openocd interface. Use lower-case letters, digits, _ and -, as in stlink or cmsis-dap.",
      name);
}

std::string intel_hex(const Image& image) {
  constexpr std::size_t record_bytes = 16;
  std::string text;
  std::uint32_t upper = 0;
  for (const Segment& segment : image.segments) {
    for (std::size_t i = 0; i < segment.bytes.size();) {
      const std::uint32_t address = segment.address + static_cast<std::uint32_t>(i);
      if (address >> 16 != upper) {
        upper = address >> 16;
        append_record(text, HexRecord::upper_address, 0,
                      std::array{std::byte(upper >> 8 & 0xFF), std::byte(upper & 0xFF)});
      }
      // A record ends at the next multiple of the record size, so no record crosses a 64 KiB boundary.
      const std::size_t count =
          std::min(segment.bytes.size() - i, record_bytes - static_cast<std::size_t>(address) % record_bytes);
      append_record(text, HexRecord::data, static_cast<std::uint16_t>(address),
                    std::span(segment.bytes).subspan(i, count));
      i += count;
    }
  }
  append_record(text, HexRecord::end, 0, {});
  return text;
}

namespace {

std::vector<std::string> openocd_arguments(const DebugProbe& probe, std::initializer_list<std::string> commands) {
  std::vector<std::string> arguments{"-f", fmt::format("interface/{}.cfg", probe.interface), "-f",
                                     "target/stm32f4x.cfg"};
  if (!probe.serial_number.empty()) {
    arguments.emplace_back("-c");
    arguments.push_back(fmt::format("adapter serial {}", probe.serial_number));
  }
  for (const auto& command : commands) {
    arguments.emplace_back("-c");
    arguments.push_back(command);
  }
  return arguments;
}

int run_openocd(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                const std::function<void(const std::string&)>& on_line) {
  Lines lines(on_line);
  std::vector<std::string> words{"openocd"};
  std::ranges::copy(arguments, std::back_inserter(words));
  const int exit_code = device::run_child_program(
      {.words = words,
       .folder = folder,
       .advice = "Install it (Debian: the package openocd), or flash over USB: inkwell flash."},
      [&](std::string_view piece) { lines.add(piece); });
  lines.end();
  return exit_code;
}

std::optional<protocol::ImageIdentity> read_installed(const DebugProbe& probe, const std::filesystem::path& folder,
                                                      const std::function<void(const std::string&)>& on_line) {
  if (run_openocd(openocd_arguments_for_reading(probe), folder, on_line) != 0) throw device::Error(cannot_read);
  std::ifstream file(folder / installed_file, std::ios::binary);
  std::vector<std::byte> begin_of_flash(identity_end);
  if (!file.read(reinterpret_cast<char*>(begin_of_flash.data()), static_cast<std::streamsize>(begin_of_flash.size())))
    throw device::Error(cannot_read);
  return identity_in(begin_of_flash);
}

/// Returns the text of a file of one line, or an empty text.
std::string line_in(const std::filesystem::path& file) {
  std::string line;
  std::ifstream stream(file);
  std::getline(stream, line);
  return line;
}

/// Only these characters can be part of a command of openocd.
bool is_serial_number(std::string_view text) {
  return std::ranges::all_of(
      text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == ':'; });
}

/// openocd would use any of several probes, which may be connected to another board.
void check_choice(const DebugProbe& probe) {
  if (!is_serial_number(probe.serial_number))
    throw device::Error(
        fmt::format("`{}` is not the serial number of a debug probe. Give the letters and digits that are printed on "
                    "the probe or listed by lsusb -v.",
                    protocol::plain_text(probe.serial_number)));
  const auto connected = serial_numbers_of_probes(probe);
  const auto listed = fmt::format("{}", fmt::join(connected, ", "));
  if (probe.serial_number.empty() && connected.size() > 1)
    throw device::Error(
        fmt::format("{} debug probes are connected: {}. Choose one with --probe-serial NUMBER. Nothing was changed.",
                    connected.size(), listed));
  if (!probe.serial_number.empty() && !connected.empty() &&
      std::ranges::find(connected, probe.serial_number) == connected.end())
    throw device::Error(fmt::format("No debug probe with the serial number {} is connected. Choose one of these: {}.",
                                    probe.serial_number, listed));
}

}  // namespace

std::vector<std::string> serial_numbers_of_probes(const DebugProbe& probe) {
  std::vector<std::string> serial_numbers;
  std::error_code code;
  for (std::filesystem::directory_iterator device(probe.usb_devices, code), end; !code && device != end;
       device.increment(code)) {
    const auto text = [&](const char* name) { return protocol::plain_text(line_in(device->path() / name)); };
    const std::string product = text("product"), vendor = text("idVendor");
    // The names and numbers that the manufacturers use for all models.
    const bool is_probe = probe.interface.starts_with("stlink")
                              ? vendor == "0483" && text("idProduct").starts_with("37")
                          : probe.interface.starts_with("cmsis-dap") ? product.find("CMSIS-DAP") != std::string::npos
                          : probe.interface == "jlink"               ? vendor == "1366"
                                                                     : false;
    if (is_probe) serial_numbers.push_back(text("serial"));
  }
  std::ranges::sort(serial_numbers);
  return serial_numbers;
}

std::vector<std::string> openocd_arguments_for_reading(const DebugProbe& probe) {
  return openocd_arguments(
      probe,
      {fmt::format("init; dump_image {} {:#x} {}", installed_file, protocol::image_begin, identity_end), "shutdown"});
}

std::vector<std::string> openocd_arguments_for_writing(const DebugProbe& probe) {
  // FLASH_OPTCR: BOR_LEV 0 selects level 3; the other bits of the user byte are retained (RM0090, "Option bytes").
  const std::string set_brown_out =
      "set optcr [lindex [read_memory 0x40023c14 32 1] 0]; "
      "if {($optcr & 0x0c) != 0} { stm32f2x options_write 0 [expr {$optcr & 0xe0}] }";
  return openocd_arguments(probe,
                           {fmt::format("init; reset halt; flash write_image erase {0}; verify_image {0}", image_file),
                            fmt::format("echo {{{}}}", verified_line), set_brown_out, "reset run; shutdown"});
}

void update_by_probe(const Image& image, const DebugProbe& probe, Consent consent,
                     const std::function<void(const std::string&)>& on_line) {
  if (!is_interface_name(probe.interface)) throw device::Error(no_interface_name(probe.interface));
  check_choice(probe);
  const auto folder = device::make_private_folder();
  std::optional<protocol::ImageIdentity> installed;
  if (consent != Consent::to_everything) installed = read_installed(probe, folder.path(), on_line);
  insist(image, installed, consent);
  write_image_file(image, folder.path() / image_file);
  bool is_verified = false;
  const auto note_line = [&](const std::string& line) {
    is_verified |= line == verified_line;
    on_line(line);
  };
  if (run_openocd(openocd_arguments_for_writing(probe), folder.path(), note_line) != 0) throw device::Error(cannot_use);
  if (!is_verified) throw device::Error(not_verified);
}

}  // namespace inkwell::firmware_update
