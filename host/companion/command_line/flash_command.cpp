#include "host/companion/command_line/commands.hpp"

#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "boards/known/boards.hpp"
#include "host/client/command_line/help.hpp"
#include "host/client/command_line/interrupt.hpp"
#include "host/client/firmware_update/flash_file.hpp"
#include "host/client/firmware_update/probe.hpp"
#include "host/client/firmware_update/update.hpp"
#include "host/client/installation/installed_paths.hpp"
#include "host/client/local/output.hpp"

#include "host/companion/command_line/progress_bar.hpp"

namespace inkwell::command_line {
namespace {

using NewImage = firmware_update::Image;
using nlohmann::ordered_json;

struct FlashOptions {
  std::filesystem::path image;
  std::string board;
  firmware_update::ImageFor image_for = firmware_update::always_the_given;
  bool by_usb = false, by_probe = false, says_yes = false, allows_downgrade = false;
  std::filesystem::path flash_file;
  firmware_update::DebugProbe probe;

  firmware_update::Consent consent() const {
    using firmware_update::Consent;
    return says_yes ? Consent::to_everything : allows_downgrade ? Consent::to_downgrade : Consent::none;
  }
};

std::string before_text(const std::optional<protocol::ImageIdentity>& before) {
  return before ? firmware_update::describe(*before)
                : std::string("unidentified data, so the image could not be checked against the board");
}

ordered_json to_json(const NewImage& image, const std::optional<protocol::ImageIdentity>& before) {
  const auto text = [](const auto& identity) {
    return identity ? ordered_json(firmware_update::describe(*identity)) : ordered_json(nullptr);
  };
  return {{"image", image.file.string()}, {"written", text(image.identity)}, {"before", text(before)}};
}

int flash_by_usb(const DeviceOptions& options, const FlashOptions& given, const NewImage& image) {
  const InterruptGuard interrupt;
  ProgressBar progress;
  firmware_update::UpdateResult result;
  try {
    result = firmware_update::update(options.address(), image,
                                     {.consent = given.consent(),
                                      .image_for = given.image_for,
                                      .on_progress = [&](std::string_view step, double done) { progress(step, done); },
                                      .is_cancelled = [&] { return interrupt.is_interrupted(); }});
  } catch (...) {
    progress.end();
    throw;
  }
  if (options.json) {
    auto json = to_json(result.written, result.before);
    json["brown_out_level_set"] = result.has_set_brown_out;
    json["serial_number"] = result.serial_number;
    json["firmware_version"] = result.firmware_version;
    json["protocol_version"] = result.protocol_version;
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("The board contained {}.\n", before_text(result.before));
    if (result.has_set_brown_out) fmt::print("The board's brown-out level was changed to 3.\n");
  }
  if (result.firmware_version.empty())
    throw device::Error(
        "The firmware was written and verified, but the board does not respond. Switch its power off and on, then run "
        "`inkwell info`.");
  if (!options.json)
    fmt::print("Arm {} now runs firmware {}, protocol {}.\n", result.serial_number, result.firmware_version,
               result.protocol_version);
  return 0;
}

int flash_file(const DeviceOptions& options, const FlashOptions& given, const NewImage& image) {
  const auto [before, written, warning] =
      firmware_update::write_flash_file(given.flash_file, image, given.consent(), given.image_for);
  if (!warning.empty()) local::print_error("inkwell: {}\n", warning);
  if (options.json)
    fmt::print("{}\n", to_json(written, before).dump(2));
  else
    fmt::print("{} now contains {}. Before, it contained {}.\n", given.flash_file.string(),
               written.identity ? firmware_update::describe(*written.identity) : written.file.string(),
               before_text(before));
  return 0;
}

int write(const DeviceOptions& options, const FlashOptions& given, const NewImage& image) {
  if (!given.flash_file.empty()) return flash_file(options, given, image);
  if (!given.by_probe) return flash_by_usb(options, given, image);
  firmware_update::update_by_probe(image, given.probe, given.consent(),
                                   [](const std::string& line) { local::print_error("{}\n", line); });
  fmt::print("{}\n", options.json ? to_json(image, std::nullopt).dump(2)
                                  : std::string("The firmware was written, verified and started."));
  return 0;
}

int flash(const DeviceOptions& options, FlashOptions given) {
  if (options.is_virtual)
    throw UsageError(
        "The firmware cannot be written to the virtual board of `inkwell --virtual flash`, because this board exits "
        "after the command. Use `inkwell flash --virtual FILE` for the flash file of a virtual board, or --usbip "
        "HOST:PORT for a running virtual board.");
  if (!given.board.empty()) {
    given.image = installation::firmware(board::image_name(*board::find_board(given.board)));
  } else if (given.image.empty()) {
    // The program requires an explicit image, because an image for the wrong board drives the wrong pins.
    if (given.by_probe && std::size(board::known_boards) > 1)
      throw UsageError(
          fmt::format("A debug probe cannot identify the board. Name the image, or choose the board with --board: {}.",
                      board::names_of_boards()));
    given.image = installation::firmware();
    given.image_for = firmware_update::own_image_for;
  }
  const NewImage image = firmware_update::read_image(given.image);
  try {
    return write(options, given, image);
  } catch (const firmware_update::Downgrade& downgrade) {
    throw device::Error(fmt::format("{} To write it anyway, add --allow-downgrade.", downgrade.what()));
  } catch (const firmware_update::Objected& objection) {
    throw device::Error(fmt::format("{} To write it anyway, add --yes.", objection.what()));
  }
}

}  // namespace

void add_flash_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "flash",
      "Writes a firmware image to a board, verifies it and starts it\n"
      "\n"
      "Over USB the board restarts into the boot loader of its chip. The command also finds a board that\n"
      "is already in the boot loader because BOOT0 was pressed at power-on. Stored parameters are retained. If the "
      "command\n"
      "was interrupted, run it again.");
  const auto given = std::make_shared<FlashOptions>();
  auto* image = command->add_option("IMAGE", given->image,
                                    "Firmware image (ELF). Default: the installed image for the connected board");
  std::vector<std::string> boards;
  for (const board::Facts* each : board::known_boards) boards.emplace_back(each->name);
  command
      ->add_option("--board", given->board, "Write the installed image for this board; --swd requires --board or IMAGE")
      ->check(CLI::IsMember(boards))
      ->excludes(image);
  auto* by_usb = command->add_flag("--dfu", given->by_usb, "Write over USB (default)");
  auto* by_probe =
      command->add_flag("--swd", given->by_probe, "Write with openocd and a debug probe at the board's SWD connector");
  auto* file = command
                   ->add_option("--virtual", given->flash_file,
                                "Write to the flash file of `virtual-board --flash`, while no board uses the file")
                   ->type_name("FILE")
                   ->check(not_empty());
  by_usb->excludes(by_probe)->excludes(file);
  by_probe->excludes(file);
  const CLI::Validator is_interface_name(
      [](const std::string& name) {
        return firmware_update::is_interface_name(name) ? std::string() : firmware_update::no_interface_name(name);
      },
      "");
  command
      ->add_option("--interface", given->probe.interface, "Debug probe for --swd: name of its openocd interface file")
      ->type_name("NAME")
      ->check(is_interface_name)
      ->capture_default_str()
      ->needs(by_probe);
  command
      ->add_option("--probe-serial", given->probe.serial_number,
                   "Use the debug probe with this serial number; required if several are connected")
      ->type_name("NUMBER")
      ->check(not_empty())
      ->needs(by_probe);
  command->add_flag("--allow-downgrade", given->allows_downgrade,
                    "Write the image even if it is older than the firmware on the board");
  command->add_flag("--yes", given->says_yes,
                    "Write the image even if it is damaged, older, or for another board or protocol");
  add_examples(
      *command,
      "inkwell flash\ninkwell flash build/board/inkwell.elf\ninkwell flash --swd --board omni_driver\n"
      "inkwell flash --swd --interface cmsis-dap build/board/inkwell.elf\ninkwell flash --virtual board.flash");
  command->callback(
      [context, given] { context.action = [&options = context.device, given] { return flash(options, *given); }; });
}

}  // namespace inkwell::command_line
