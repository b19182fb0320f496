#include "host/companion/command_line/commands.hpp"

#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "boards/known/boards.hpp"
#include "host/client/command_line/help.hpp"
#include "host/client/device/board_store.hpp"
#include "host/client/device/fault_text.hpp"
#include "protocol/reports.hpp"

namespace inkwell::command_line {
namespace {

using namespace std::chrono_literals;
using nlohmann::ordered_json;

ordered_json law_signals(const device::ForceLaw& law) {
  ordered_json json = ordered_json::array();
  for (const auto& row : law.signals) json.push_back({{"name", row.name}, {"unit", row.unit}, {"help", row.help}});
  return json;
}

std::string board_text(const std::string& name) {
  if (name.empty()) return "unknown: the firmware does not report it";
  return board::find_board(name) ? name : name + ", which is unknown to this companion";
}

ordered_json to_json(const device::Information& information, const protocol::StoreReport& store,
                     const std::optional<device::Pose>& pose, const std::optional<device::Driver>& driver) {
  const auto& report = information.report;
  ordered_json json{{"serial_number", information.serial_number},
                    {"board", information.board_name},
                    {"firmware_version", information.firmware_version},
                    {"protocol_version", information.protocol_version},
                    {"companion_version", INKWELL_VERSION},
                    {"servo_rate_Hz", report.servo_rate_Hz},
                    {"processor_clock_Hz", report.processor_clock_Hz},
                    {"servo_cycles_longest", report.servo_cycles_longest},
                    {"servo_overruns", report.servo_overruns},
                    {"pose_reports_dropped", report.pose_reports_dropped},
                    {"scope_samples_dropped", report.scope_samples_dropped},
                    {"force_reports", report.force_reports},
                    {"force_reports_lost", report.force_reports_lost},
                    {"force_reports_late", report.force_reports_late},
                    {"force_reports_refused", report.force_reports_refused},
                    {"reset_cause", report.reset_cause},
                    {"image_check", fmt::format("{:08x}", report.image_check)},
                    {"motor_heat", report.motor_heat},
                    {"stored", info(store.contents).name},
                    {"not_stored", store.differing}};
  if (const auto& law = information.force_law)
    json["force_law"] = {{"name", law->name}, {"help", law->help}, {"signals", law_signals(*law)}};
  if (pose) {
    json["state"] = info(pose->state).name;
    json["fault"] = info(pose->fault).name;
    json["referenced"] = pose->is_referenced;
    json["supply_V"] = pose->supply_dV / 10.0;
  }
  if (driver)
    json["driver"] = {{"program", driver->program}, {"process_id", driver->process_id}, {"driven_s", driver->driven_s}};
  return json;
}

void print(const device::Information& information, const protocol::StoreReport& store,
           const std::optional<device::Pose>& pose, const std::optional<device::Driver>& driver) {
  const auto& report = information.report;
  const double cycles_per_period = static_cast<double>(report.processor_clock_Hz) / std::max(1u, report.servo_rate_Hz);
  fmt::print("serial number       {}\n", information.serial_number);
  fmt::print("board               {}\n", board_text(information.board_name));
  fmt::print("firmware            {}, image {:08x}, protocol {} (companion {})\n", information.firmware_version,
             report.image_check, information.protocol_version, INKWELL_VERSION);
  if (const auto& law = information.force_law) {
    fmt::print("force law           {}: {}\n", law->name, law->help);
    for (const auto& row : law->signals)
      fmt::print("                    signal {} {}: {}\n", row.name, row.unit, row.help);
  }
  fmt::print("control             {} Hz; longest interrupt {} cycles, {:.0f} % of its period; {} overruns\n",
             report.servo_rate_Hz, report.servo_cycles_longest, 100.0 * report.servo_cycles_longest / cycles_per_period,
             report.servo_overruns);
  fmt::print("dropped             {} pose reports, {} scope samples, since the board started\n",
             report.pose_reports_dropped, report.scope_samples_dropped);
  fmt::print("forces of programs  {} received, {} lost, {} late, {} refused\n", report.force_reports,
             report.force_reports_lost, report.force_reports_late, report.force_reports_refused);
  fmt::print("motor heat          {:.0f} %, {:.0f} %, {:.0f} % of the heat at continuous current\n",
             100.0 * report.motor_heat[0], 100.0 * report.motor_heat[1], 100.0 * report.motor_heat[2]);
  fmt::print("stored parameters   {}{}\n", info(store.contents).meaning,
             store.differing == 0 ? "" : fmt::format(" {} current values differ.", store.differing));
  fmt::print("driven by           {}\n", driver ? device::driver_text(*driver) : "no program");
  if (!pose) {
    fmt::print("state               unknown: the device sends no pose\n");
    return;
  }
  fmt::print("supply              {:.1f} V\n", pose->supply_dV / 10.0);
  fmt::print("state               {}: {}\n", info(pose->state).name, info(pose->state).meaning);
  if (pose->fault != protocol::Fault::none) fmt::print("fault               {}\n", device::fault_line(pose->fault));
  fmt::print("position of the arm {}\n",
             pose->is_referenced ? "known" : "unknown: put the stylus into the inkwell once");
}

}  // namespace

void add_info_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "info", "Shows the connected device: versions, counters, state, and fault with remedy");
  add_examples(*command, "inkwell info\ninkwell info --virtual --json");
  command->callback([context] {
    context.action = [&options = context.device] {
      const auto connection = connect(options);
      const auto pose = connection.device->read_pose(500ms);
      const auto information = connection.device->information();
      const auto store = connection.device->store_report();
      const auto driver = connection.device->driver();
      if (options.json)
        fmt::print("{}\n", to_json(information, store, pose, driver).dump(2));
      else
        print(information, store, pose, driver);
      return 0;
    };
  });
}

}  // namespace inkwell::command_line
