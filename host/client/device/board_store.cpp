#include "host/client/device/board_store.hpp"

#include <fmt/format.h>

namespace inkwell::device {
namespace {

using protocol::Command;
using protocol::StoreReport;
using protocol::StoreResult;

/// Time limit for a flash operation, in board time.
constexpr std::int64_t patience_periods = protocol::servo_rate_Hz;

constexpr std::string_view was_not_stored = "The parameters were not stored.";
constexpr std::string_view was_not_forgotten = "The stored parameters were not erased.";

bool is_carried_out(StoreResult result) { return result == StoreResult::done || result == StoreResult::nothing_stored; }

std::int64_t board_periods(Device& device) {
  const auto bus_frame = device.bus_frame();
  if (!bus_frame) throw Error("The board receives no bus frames, so its time is unknown. Reconnect the board.");
  return bus_frame->time_periods;
}

/// Waits until the command counter changes, because an unchanged counter belongs to the previous result.
StoreReport carry_out(Device& device, Command command, std::string_view failure) {
  const std::uint32_t commands_before = device.store_report().commands;
  device.carry_out(command);
  const std::int64_t begin_periods = board_periods(device);
  for (;;) {
    const bool is_late = board_periods(device) - begin_periods > patience_periods;
    const StoreReport report = device.store_report();
    const bool is_taken = report.commands != commands_before;
    if (is_taken && is_carried_out(report.result)) return report;
    if (is_taken && (is_late || report.result != StoreResult::under_way)) throw NotStored(failure, report);
    if (is_late)
      throw Error(fmt::format("{} The board did not execute the command. Reset the board and try again.", failure));
  }
}

}  // namespace

NotStored::NotStored(std::string_view what, const StoreReport& refused_report)
    : Error(fmt::format("{} {} {}", what, info(refused_report.result).meaning, info(refused_report.result).remedy)),
      report(refused_report) {}

BoardStore read_store(Device& device) {
  BoardStore store{};
  store.report = device.store_report();
  store.at_next_start = device.stored_parameters();
  return store;
}

std::vector<protocol::Parameter> not_stored(const protocol::ParameterSet& held, const BoardStore& store) {
  std::vector<protocol::Parameter> differing;
  for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i)
    if (held.values[i] != store.at_next_start.values[i]) differing.push_back(static_cast<protocol::Parameter>(i));
  return differing;
}

StoreReport store_parameters(Device& device) { return carry_out(device, Command::store_parameters, was_not_stored); }
StoreReport factory_reset(Device& device) { return carry_out(device, Command::factory_reset, was_not_forgotten); }

}  // namespace inkwell::device
