#include "host/companion/command_line/commands.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/client/command_line/help.hpp"
#include "host/client/device/fault_text.hpp"
#include "protocol/report_table.hpp"
#include "protocol/self_test.hpp"
#include "protocol/store.hpp"
#include "protocol/supervision.hpp"
#include "protocol/usb_identity.hpp"

#include "host/companion/command_line/wire_reference.hpp"

namespace inkwell::command_line {
namespace {

std::string_view kind_text(protocol::ReportKind kind) {
  switch (kind) {
    case protocol::ReportKind::input: return "input";
    case protocol::ReportKind::output: return "output";
    case protocol::ReportKind::feature: return "feature";
  }
  return "";
}

void print_reports() {
  fmt::print(
      "## Reports of the HID interface\n"
      "\n"
      "The tables below list the fields of the reports and of the scope frames. Scope frames use interface {}, "
      "endpoint 0x{:02x}. When the host reads a report, the device pads the report with zeros to its declared size. A "
      "written report may have any length from its shortest write to the longest report of its kind ({} bytes for "
      "output, {} for feature reports). The device ignores the bytes after the used part. The device reports a full "
      "queue and a refusal as results, and stalls only unknown requests.\n"
      "\n"
      "| id | kind | read | written | declared bytes | shortest write | meaning |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n",
      protocol::usb::scope_interface, protocol::usb::scope_in_endpoint,
      protocol::longest_report(protocol::ReportKind::output), protocol::longest_report(protocol::ReportKind::feature));
  const auto structure = [](std::string_view name) { return name == "none" ? std::string_view("-") : name; };
  for (std::size_t i = 0; i < protocol::report_table.size(); ++i) {
    const auto& row = protocol::report_table[i];
    const auto& text = protocol::report_texts[i];
    fmt::print("| 0x{:02x} | {} | {} | {} | {} | {} | {} |\n", static_cast<unsigned>(row.id), kind_text(row.kind),
               structure(text.get), structure(text.set), row.bytes,
               row.can_be_set() ? fmt::format("{}", row.set_bytes_minimum) : "-", text.meaning);
  }
  fmt::print(
      "\n"
      "Interface {}, endpoint 0x{:02x}, is a separate HID multi-axis controller. It sends a ControllerReport of {} "
      "bytes every {} ms, without an id. Interface {} is the run-time interface of USB device firmware upgrade. A "
      "DETACH while the force is on completes without effect, and GETSTATUS then reports errVENDOR (0x0B) in the state "
      "appIDLE until a DETACH is accepted.\n",
      protocol::usb::controller_interface, protocol::usb::controller_in_endpoint, sizeof(protocol::ControllerReport),
      protocol::usb::controller_interval_ms, protocol::usb::firmware_update_interface);
}

std::string names_of(protocol::Events events) {
  std::vector<std::string_view> names;
  for (const auto& row : protocol::event_table)
    if ((events & protocol::events(row.event)).any()) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string names_of(protocol::States states) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < protocol::state_count; ++i)
    if (states.contains(static_cast<protocol::State>(i))) names.push_back(protocol::state_table[i].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string_view text(protocol::Clearing clearing) {
  switch (clearing) {
    case protocol::Clearing::when_gone: return "when its cause is gone";
    case protocol::Clearing::at_once: return "immediately";
    case protocol::Clearing::by_reset: return "only by a reset of the board";
  }
  return "";
}

std::string_view text(protocol::Off off) {
  switch (off) {
    case protocol::Off::coast: return "coasts";
    case protocol::Off::brake: return "is braked";
    case protocol::Off::brake_gently: return "is braked gently";
  }
  return "";
}

void print_supervision() {
  fmt::print("\n## States\n\n| code | state | force | meaning |\n| --- | --- | --- | --- |\n");
  for (std::size_t i = 0; i < protocol::state_count; ++i) {
    const auto& row = protocol::state_table[i];
    fmt::print("| {} | {} | {} | {} |\n", i, row.name, row.force_is_on ? "on" : "off", row.meaning);
  }
  fmt::print(
      "\n"
      "In every control period the supervisor follows the first open transition. A detected fault has precedence.\n\n"
      "| from | to | needs | unless |\n"
      "| --- | --- | --- | --- |\n");
  for (const auto& transition : protocol::transition_table)
    fmt::print("| {} | {} | {} | {} |\n", info(transition.from).name, info(transition.to).name,
               names_of(transition.needs), names_of(transition.unless));
  fmt::print("\n| event | meaning |\n| --- | --- |\n");
  for (const auto& row : protocol::event_table) fmt::print("| {} | {} |\n", row.name, row.meaning);
  fmt::print(
      "\n"
      "## Monitored faults\n"
      "\n"
      "If several faults occur in one period, the board reports the first of them in this list. A braked motor is "
      "shorted through the low sides of its bridge until the arm is slow. Gentle braking pauses while a motor current "
      "exceeds a fraction of the current for the force limit.\n"
      "\n"
      "| fault | monitored in | can be cleared | moving arm |\n"
      "| --- | --- | --- | --- |\n");
  for (const auto& row : protocol::condition_table)
    fmt::print("| {} | {} | {}{} | {} |\n", info(row.fault).name, names_of(row.monitored_in), text(row.clearing),
               row.voids_reference ? ", and the arm must be referenced again" : "", text(row.off));
}

void print_self_test() {
  fmt::print(
      "\n"
      "## Self-test\n"
      "\n"
      "The self-test runs after each start and on command. A failed item disables the force if its third column "
      "contains yes.\n"
      "\n"
      "| item | figure | disables the force | expected | remedy |\n"
      "| --- | --- | --- | --- | --- |\n");
  for (const auto& row : protocol::self_test_item_table)
    fmt::print("| {} | {} | {} | {} | {} |\n", row.name, row.unit, row.takes_force ? "yes" : "no", row.meaning,
               row.remedy);
  fmt::print("\n| result | meaning |\n| --- | --- |\n");
  for (const auto& row : protocol::self_test_result_table) fmt::print("| {} | {} |\n", row.name, row.meaning);
}

void print_store() {
  fmt::print(
      "\n"
      "## Parameter store\n\n"
      "Results of the last command that stored or erased the parameters.\n\n"
      "| result | meaning | remedy |\n"
      "| --- | --- | --- |\n");
  for (const auto& row : protocol::store_result_table)
    fmt::print("| {} | {} | {} |\n", row.name, row.meaning, row.remedy);
  fmt::print("\n| contents | meaning |\n| --- | --- |\n");
  for (const auto& row : protocol::store_contents_table) fmt::print("| {} | {} |\n", row.name, row.meaning);
}

void print_codes() {
  fmt::print(
      "\n"
      "## Force sources\n\n"
      "| bit | source | meaning |\n"
      "| --- | --- | --- |\n");
  for (const auto& row : protocol::force_source_table)
    fmt::print("| {} | {} | {} |\n", static_cast<unsigned>(row.source), row.name, row.meaning);
  fmt::print(
      "\n"
      "## Force limits\n\n"
      "| bit | limit | meaning |\n"
      "| --- | --- | --- |\n");
  for (const auto& row : protocol::limit_table)
    fmt::print("| {} | {} | {} |\n", static_cast<unsigned>(row.limit), row.name, row.meaning);
  fmt::print("\n## Faults\n\n| code | fault | cause | remedy |\n| --- | --- | --- | --- |\n");
  for (const auto& row : protocol::fault_table) {
    const auto text = device::fault_text(static_cast<protocol::Fault>(row.code));
    fmt::print("| {} | {} | {} | {} |\n", row.code, row.name, text.cause, text.remedy);
  }
  fmt::print("\n## Results of requests\n\n| code | result | meaning | remedy |\n| --- | --- | --- | --- |\n");
  for (std::size_t code = 0; code < protocol::request_result_table.size(); ++code) {
    const auto& row = protocol::request_result_table[code];
    fmt::print("| {} | {} | {} | {} |\n", code, row.name, row.meaning, row.remedy);
  }
  fmt::print("\n## Refusals of a transaction\n\n| code | refusal | cause | remedy |\n| --- | --- | --- | --- |\n");
  for (const auto& row : protocol::refusal_table)
    fmt::print("| {} | {} | {} | {} |\n", row.code, row.name, row.cause, row.remedy);
}

void print_tables() {
  fmt::print(
      "\n"
      "## Parameters\n"
      "\n"
      "| id | parameter | unit | range | default | meaning |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  for (const auto& row : protocol::parameter_table)
    fmt::print("| {} | `{}` | {} | {:g} to {:g} | {:g} | {} |\n", row.id, row.name, row.unit, row.minimum, row.maximum,
               row.default_value, row.help);
  fmt::print(
      "\n"
      "## Signals of the scope\n"
      "\n"
      "| id | signal | unit | on the wire | meaning |\n"
      "| --- | --- | --- | --- | --- |\n");
  for (const auto& row : protocol::signal_table)
    fmt::print("| {} | `{}` | {} | {} | {} |\n", row.id, row.name, row.unit, name_of(row.wire), row.help);
}

}  // namespace

void add_reference_command(const CommandContext& context) {
  auto* command = context.program.add_subcommand(
      "reference", "Prints reports, states, codes, parameters and signals as Markdown; needs no device");
  add_examples(*command, "inkwell reference > protocol.md");
  command->callback([context] {
    context.action = [] {
      fmt::print(
          "# Protocol, version {}\n\n"
          "USB {:04x}:{:04x}{}. Generated by `inkwell reference` from the tables that firmware and companion "
          "share.\n\n",
          protocol::protocol_version, protocol::usb::vendor_id, protocol::usb::product_id,
          protocol::usb::is_test_identity ? ", a test identifier that other devices may also use" : "");
      print_reports();
      print_wire();
      print_supervision();
      print_self_test();
      print_store();
      print_codes();
      print_tables();
      return 0;
    };
  });
}

}  // namespace inkwell::command_line
