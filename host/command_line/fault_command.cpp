#include "commands.hpp"

#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <device/fault_text.hpp>
#include <protocol/black_box.hpp>
#include <recording/black_box.hpp>
#include <recording/writer.hpp>

#include "help.hpp"
#include "next_pose.hpp"

namespace inkwell::command_line {
namespace {

using nlohmann::ordered_json;
using protocol::BlackBoxReport;
using protocol::Fault;
using protocol::PoseReport;
using protocol::State;

struct FaultOptions {
  std::string file;
  bool overwrite = false;
};

double time_s(const BlackBoxReport& box) { return static_cast<double>(box.fault_periods) / protocol::servo_rate_Hz; }

bool has_crash(const BlackBoxReport& box) { return box.crash.exception != 0; }

std::string crash_text(const protocol::CrashFacts& crash) {
  const std::string where = crash.program_counter == 0 ? "at an unknown place, for its stack could not be read"
                                                       : fmt::format("at 0x{:08x}, called from 0x{:08x}",
                                                                     crash.program_counter, crash.link_register & ~1u);
  const std::string names = crash.program_counter == 0
                                ? ""
                                : fmt::format(
                                      " `arm-none-eabi-addr2line -fiCe inkwell.elf 0x{:08x} 0x{:08x}` names the "
                                      "functions, with the firmware's own ELF.",
                                      crash.program_counter, crash.link_register & ~1u);
  return fmt::format("The processor met exception {} {}. CFSR 0x{:08x}, HFSR 0x{:08x}, BFAR 0x{:08x}.{}",
                     crash.exception, where, crash.configurable_fault_status, crash.hard_fault_status,
                     crash.fault_address, names);
}

ordered_json to_json(const BlackBoxReport& box) {
  if (box.fault == Fault::none) return nullptr;
  ordered_json json{{"fault", info(box.fault).name},
                    {"time_s", time_s(box)},
                    {"rows", box.row_count},
                    {"rows_before", box.rows_before},
                    {"complete", box.is_complete != 0},
                    {"restart", box.is_restart != 0},
                    {"crash", nullptr}};
  if (has_crash(box))
    json["crash"] = {{"exception", box.crash.exception},
                     {"program_counter", box.crash.program_counter},
                     {"link_register", box.crash.link_register},
                     {"configurable_fault_status", box.crash.configurable_fault_status},
                     {"hard_fault_status", box.crash.hard_fault_status},
                     {"fault_address", box.crash.fault_address}};
  return json;
}

void print(const BlackBoxReport& box) {
  if (box.fault == Fault::none) return;
  fmt::print(
      "A black box is kept: every signal around {} at {:.3f} s, each millisecond, {} rows before it and {} from "
      "then on{}. `inkwell fault --out FILE` saves it; it goes when the force is switched on.\n",
      info(box.fault).name, time_s(box), box.rows_before, box.row_count - box.rows_before,
      box.is_restart ? ", where the board was restarted" : "");
  if (has_crash(box)) fmt::print("{}\n", crash_text(box.crash));
}

void tell_fault(const DeviceOptions& options, const PoseReport& pose, const BlackBoxReport& box) {
  const bool is_fault = pose.state == State::fault;
  if (options.json) {
    fmt::print("{}\n", ordered_json{{"state", info(pose.state).name},
                                    {"fault", info(is_fault ? pose.fault : Fault::none).name},
                                    {"black_box", to_json(box)}}
                           .dump());
    return;
  }
  if (is_fault)
    fmt::print("{}\n", device::fault_line(pose.fault));
  else
    fmt::print("No fault. The device is {}: {}\n", info(pose.state).name, info(pose.state).meaning);
  print(box);
}

int show_fault(const DeviceOptions& options) {
  const auto connection = connect(options);
  const auto pose = next_pose(*connection.device);
  tell_fault(options, pose, connection.device->black_box());
  return 0;
}

/// The board takes a tenth of a second of its time to fill it.
BlackBoxReport complete_black_box(device::Device& device) {
  constexpr std::uint32_t patience_periods = protocol::servo_rate_Hz;
  const std::uint32_t begin_periods = next_pose(device).time_periods;
  for (;;) {
    const auto box = device.black_box();
    if (box.fault == Fault::none)
      throw device::Error(
          "No black box is kept: there was no fault since the force was last switched on, or since the "
          "power came.");
    if (box.is_complete) return box;
    if (next_pose(device).time_periods - begin_periods > patience_periods)
      throw device::Error("The board does not finish its black box. Report this with the firmware version.");
  }
}

int save_black_box(const DeviceOptions& device_options, const FaultOptions& options) {
  try {
    recording::check_can_be_created(options.file,
                                    options.overwrite ? recording::Existing::is_replaced : recording::Existing::stays);
  } catch (const device::Error& error) {
    throw UsageError(error.what());
  }
  const auto connection = connect(device_options);
  device::Device& device = *connection.device;
  const auto box = complete_black_box(device);
  const auto recording = recording::of_black_box(
      box, device.black_box_rows(box),
      recording::describe(device.information(), device.parameters(), recording::black_box_signals(),
                          arm_name(device_options), connection.endpoint.is_virtual));
  recording::save(recording, options.file);
  if (device_options.json) {
    fmt::print("{}\n", ordered_json{{"file", options.file}, {"black_box", to_json(box)}}.dump());
    return 0;
  }
  fmt::print("{}: {} at {:.3f} s, {} samples of {} signals, {} before it, {} lost\n", options.file,
             info(box.fault).name, time_s(box), recording.size(), recording.columns.size(), box.rows_before,
             recording.lost());
  if (has_crash(box)) fmt::print("{}\n", crash_text(box.crash));
  return 0;
}

/// The board clears a fault whose cause is gone, and latches it again if it is not.
int clear_fault(const DeviceOptions& options) {
  constexpr std::uint32_t patience_periods = protocol::servo_rate_Hz / 5;
  const auto connection = connect(options);
  device::Device& device = *connection.device;
  PoseReport pose = next_pose(device);
  const bool was_fault = pose.state == State::fault;
  device.send(protocol::Command::clear_fault);
  const std::uint32_t begin_periods = pose.time_periods;
  while (was_fault && pose.time_periods - begin_periods < patience_periods) pose = next_pose(device);
  if (pose.state == State::fault)
    throw device::Error(fmt::format("The fault is there again. {}", device::fault_line(pose.fault)));
  tell_fault(options, pose, device.black_box());
  return 0;
}

}  // namespace

void add_fault_command(const Place& place) {
  auto* command = place.program.add_subcommand(
      "fault", "The fault with its cause and remedy, and the signals around it; or `clear`");
  const auto fault_options = std::make_shared<FaultOptions>();
  command->require_subcommand(0, 1);
  auto* file = command
                   ->add_option("--out", fault_options->file,
                                "Save the black box, every signal around the last fault, as a recording: .h5 or .csv")
                   ->type_name("FILE");
  command->add_flag("--overwrite", fault_options->overwrite, "Replace a file of that name")->needs(file);
  add_examples(*command, "inkwell fault\ninkwell fault --out fault.h5\ninkwell fault clear");
  command->callback([place, command, file, fault_options] {
    if (!command->get_subcommands().empty()) return;
    place.action = [&options = place.device, file, fault_options] {
      return file->count() == 0 ? show_fault(options) : save_black_box(options, *fault_options);
    };
  });
  auto* cleared = command->add_subcommand("clear", "Clears it once its cause is gone; the force stays off");
  cleared->excludes(file);
  add_examples(*cleared, "inkwell fault clear");
  cleared->callback([place] { place.action = [&options = place.device] { return clear_fault(options); }; });
}

}  // namespace inkwell::command_line
