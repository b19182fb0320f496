#include "firmware/link/command_queue.hpp"

#include "firmware/control/signal_path/installed_force_law.hpp"
#include "firmware/placement/interrupt.hpp"
#include "protocol/report_table.hpp"
#include "protocol/scope.hpp"

#include <cmath>
#include <cstring>

namespace inkwell::link {

namespace {

using protocol::Command;

bool is_valid(const protocol::SignalSelection& selection) {
  const bool has_mask = selection.count == protocol::selected_by_mask;
  if (selection.count > protocol::scope_signals_maximum && !has_mask) return false;
  const std::size_t signals = protocol::signal_count + control::installed_force_law.signal_count;
  const protocol::SelectedSignals selected = protocol::selected_signals(selection);
  for (std::size_t i = 0; i < selected.count; ++i)
    if (selected.items[i] >= signals) return false;
  return selected.count != 0 || !has_mask;
}

bool is_valid(const protocol::TestPulse& test) {
  const float amplitude = test.amplitude;
  const float duration_s = test.duration_s;
  return test.motor >= 1 && test.motor <= 3 && std::isfinite(amplitude) && duration_s >= 0.0f &&
         duration_s <= protocol::test_duration_maximum_s;
}

}  // namespace

std::optional<protocol::CommandReport> whole_command(std::span<const std::byte> report) {
  // A host may pad a report to the length of the longest report.
  constexpr std::size_t longest = protocol::longest_report(protocol::ReportKind::output);
  if (report.size() < sizeof(protocol::CommandReport) || report.size() > longest) return std::nullopt;
  protocol::CommandReport command;
  std::memcpy(&command, report.data(), sizeof command);
  if (command.report_id != protocol::ReportId::command || command.version != protocol::protocol_version)
    return std::nullopt;
  return command;
}

bool is_valid(const protocol::CommandReport& command) {
  switch (command.command) {
    case Command::heartbeat:
    case Command::enable_force:
    case Command::disable_force:
    case Command::clear_fault:
    case Command::stop:
    case Command::self_test:
    case Command::store_parameters:
    case Command::factory_reset: return true;
    case Command::select_signals: return is_valid(command.selection);
    case Command::test_current:
    case Command::test_voltage: return is_valid(command.test);
  }
  return false;
}

std::optional<protocol::CommandReport> decode_command(std::span<const std::byte> report) {
  const auto command = whole_command(report);
  return command && is_valid(*command) ? command : std::nullopt;
}

bool CommandQueue::push(const protocol::CommandReport& command) {
  note_sign_of_life();
  if (!has_room()) return false;
  const std::uint32_t pushed = pushed_.load();
  commands_[pushed % capacity] = command;
  pushed_.store(pushed + 1);
  return true;
}

bool CommandQueue::waiting(protocol::Command command) const {
  // The result may include a command that the interrupt has just removed. No waiting command is missed.
  const std::uint32_t pushed = pushed_.load();
  for (std::uint32_t i = taken_.load(); i != pushed; ++i)
    if (commands_[i % capacity].command == command) return true;
  return false;
}

void CommandQueue::host_gone() {
  sign_of_life_.store(false);
  forgotten_.store(pushed_.load());
  host_gone_.store(true);
}

INKWELL_INTERRUPT const protocol::CommandReport* CommandQueue::pop() {
  const std::uint32_t taken = taken_.load();
  if (host_gone_.load()) {
    host_gone_.store(false);
    taken_.store(forgotten_.load());
    stop_.token = last_token_;  // repeats the last token, because this command is not from the host
    return &stop_;
  }
  if (taken == pushed_.load()) return nullptr;
  const protocol::CommandReport& command = commands_[taken % capacity];
  last_token_ = command.token;
  // The main loop cannot reuse the slot before the interrupt returns.
  taken_.store(taken + 1);
  return &command;
}

}  // namespace inkwell::link
