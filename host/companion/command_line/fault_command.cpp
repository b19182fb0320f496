#include "host/companion/command_line/commands.hpp"

#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/client/command_line/help.hpp"
#include "host/client/crash/crash_text.hpp"
#include "host/client/device/clear_fault.hpp"
#include "host/client/recording/black_box.hpp"
#include "host/client/recording/writer.hpp"
#include "protocol/black_box.hpp"

#include "host/companion/command_line/next_pose.hpp"

namespace inkwell::command_line {
namespace {

using device::Pose;
using nlohmann::ordered_json;
using protocol::BlackBoxReport;
using protocol::Fault;
using protocol::State;

struct FaultOptions {
  std::string file;
  std::string elf;
  bool overwrite = false;
};

double time_s(const BlackBoxReport& box) { return device::board_time_s(box.fault_periods); }

bool has_crash(const BlackBoxReport& box) { return box.crash.exception != 0; }

using Image = std::optional<crash::FirmwareImage>;

/// Returns the image from --elf. Throws an error if the image differs from the crashed firmware.
Image image_of(const BlackBoxReport& box, const FaultOptions& options) {
  if (options.elf.empty()) return std::nullopt;
  crash::FirmwareImage image(options.elf);
  if (has_crash(box)) crash::require_image_of(box.crash, image);
  return image;
}

void print_crash(const BlackBoxReport& box, const Image& image) {
  if (!has_crash(box)) {
    if (image) fmt::print("No firmware crash is recorded, so --elf has no effect.\n");
    return;
  }
  if (box.later_crashes == 1) fmt::print("After that fault the board restarted once. The cause was:\n");
  if (box.later_crashes > 1)
    fmt::print("After that fault the board restarted {} times. The last cause was:\n", box.later_crashes);
  fmt::print("{}\n", crash::text(box.crash, image ? &*image : nullptr));
}

ordered_json crash_json(const protocol::CrashFacts& crash, const Image& image) {
  ordered_json chain = ordered_json::array();
  for (const std::uint32_t address : crash::chain(crash))
    chain.push_back(
        {{"address", address}, {"location", image ? image->source_location(address - (chain.empty() ? 0 : 2)) : ""}});
  return {{"exception", crash.exception},
          {"cause", crash::cause(crash)},
          {"chain", chain},
          {"program_counter", crash.program_counter},
          {"link_register", crash.link_register},
          {"program_status", crash.program_status},
          {"stack_pointer", crash.stack_pointer},
          {"registers", crash.registers},
          {"configurable_fault_status", crash.configurable_fault_status},
          {"hard_fault_status", crash.hard_fault_status},
          {"fault_address", crash.fault_address},
          {"image_check", crash.image_check}};
}

ordered_json to_json(const BlackBoxReport& box, const Image& image) {
  if (box.fault == Fault::none) return nullptr;
  ordered_json json{{"fault", info(box.fault).name},
                    {"time_s", time_s(box)},
                    {"rows", box.row_count},
                    {"rows_before", box.rows_before},
                    {"complete", box.is_complete != 0},
                    {"restart", box.is_restart != 0},
                    {"later_crashes", box.later_crashes},
                    {"crash", nullptr}};
  if (has_crash(box)) json["crash"] = crash_json(box.crash, image);
  return json;
}

void print(const BlackBoxReport& box, const Image& image) {
  if (box.fault == Fault::none) return print_crash(box, image);
  fmt::print(
      "The board has recorded a black box: every signal around {} at {:.3f} s, one row per millisecond. It has {} rows "
      "before the fault and {} rows from the fault on{}. Save it with `inkwell fault --out FILE`. Switching the force "
      "on deletes it.\n",
      info(box.fault).name, time_s(box), box.rows_before, box.row_count - box.rows_before,
      box.is_restart ? ", where the board restarted" : "");
  print_crash(box, image);
}

void print_fault(const DeviceOptions& options, device::Device& device, const Pose& pose, const BlackBoxReport& box,
                 const Image& image) {
  const bool is_fault = pose.state == State::fault;
  if (options.json) {
    fmt::print("{}\n", ordered_json{{"state", info(pose.state).name},
                                    {"fault", info(is_fault ? pose.fault : Fault::none).name},
                                    {"black_box", to_json(box, image)}}
                           .dump());
    return;
  }
  if (is_fault)
    fmt::print("{}\n", device::fault_line(pose.fault, device));
  else
    fmt::print("No fault. The device is {}: {}\n", info(pose.state).name, info(pose.state).meaning);
  print(box, image);
}

int show_fault(const DeviceOptions& device_options, const FaultOptions& options) {
  const auto connection = connect(device_options);
  const auto pose = next_pose(*connection.device);
  const auto box = connection.device->black_box();
  print_fault(device_options, *connection.device, pose, box, image_of(box, options));
  return 0;
}

/// Waits until the black box is complete.
BlackBoxReport complete_black_box(device::Device& device) {
  constexpr std::int64_t patience_periods = protocol::servo_rate_Hz;
  const std::int64_t begin_periods = next_pose(device).time_periods;
  for (;;) {
    const auto box = device.black_box();
    if (box.fault == Fault::none)
      throw device::Error(
          "No black box is recorded: no fault has occurred since the force was last switched on, or since power-on.");
    if (box.is_complete) return box;
    if (next_pose(device).time_periods - begin_periods > patience_periods)
      throw device::Error("The board did not complete its black box. Report this with the firmware version.");
  }
}

int save_black_box(const DeviceOptions& device_options, const FaultOptions& options) {
  if (!options.overwrite && std::filesystem::exists(options.file))
    throw UsageError(
        fmt::format("{} already exists. Give another name, or add --overwrite to replace the file.", options.file));
  try {
    recording::check_can_be_created(options.file, recording::Existing::is_replaced);
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
  const auto connection = connect(device_options);
  device::Device& device = *connection.device;
  const auto box = complete_black_box(device);
  const auto image = image_of(box, options);
  const auto recording = recording::of_black_box(
      box, device.black_box_rows(box),
      recording::describe(device.information(), device.parameters(), recording::black_box_signals(),
                          connection.arm_name, connection.endpoint.is_virtual));
  recording::save(recording, options.file);
  if (device_options.json) {
    fmt::print("{}\n", ordered_json{{"file", options.file}, {"black_box", to_json(box, image)}}.dump());
    return 0;
  }
  fmt::print("{}: {} at {:.3f} s, {} samples of {} signals, {} before the fault, {} lost\n", options.file,
             info(box.fault).name, time_s(box), recording.size(), recording.columns.size(), box.rows_before,
             recording.lost());
  print_crash(box, image);
  return 0;
}

int clear_fault(const DeviceOptions& options) {
  const auto connection = connect(options);
  device::Device& device = *connection.device;
  Pose pose = next_pose(device);
  const auto shown = [&] { return device::ShownFault{pose.time_periods, pose.state, pose.fault}; };
  device::clear_fault(device, shown(), [&] {
    pose = next_pose(device);
    return shown();
  });
  print_fault(options, device, pose, device.black_box(), std::nullopt);
  return 0;
}

}  // namespace

void add_fault_command(const CommandContext& context) {
  auto* command =
      context.program.add_subcommand("fault", "Shows the fault with cause and remedy, and saves the signals around it");
  const auto fault_options = std::make_shared<FaultOptions>();
  command->require_subcommand(0, 1);
  auto* file = command
                   ->add_option("--out", fault_options->file,
                                "Save the black box (all signals around the last fault) as a recording: .h5 or .csv")
                   ->type_name("FILE");
  command->add_flag("--overwrite", fault_options->overwrite, "Replace an existing file")->needs(file);
  auto* elf = command
                  ->add_option("--elf", fault_options->elf,
                               "ELF of the flashed firmware, to show the functions and lines of a crash or hang")
                  ->type_name("FILE")
                  ->check(CLI::ExistingFile);
  add_examples(
      *command,
      "inkwell fault\ninkwell fault --elf build/board/inkwell.elf\ninkwell fault --out fault.h5\ninkwell fault clear");
  command->callback([context, command, file, fault_options] {
    if (!command->get_subcommands().empty()) return;
    context.action = [&options = context.device, file, fault_options] {
      return file->count() == 0 ? show_fault(options, *fault_options) : save_black_box(options, *fault_options);
    };
  });
  auto* cleared = command->add_subcommand("clear", "Clears the fault once its cause is gone; the force stays off");
  cleared->excludes(file);
  cleared->excludes(elf);
  add_examples(*cleared, "inkwell fault clear");
  cleared->callback([context] { context.action = [&options = context.device] { return clear_fault(options); }; });
}

}  // namespace inkwell::command_line
