// Queue of commands from the host to the control interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/exchange/shared.hpp"
#include "protocol/reports.hpp"

namespace inkwell::link {

/// Returns the command of an output report without validation. The report starts with its report id. Returns
/// std::nullopt for a wrong length, id or version.
std::optional<protocol::CommandReport> whole_command(std::span<const std::byte> report);

/// Returns true if command, signals, motor, amplitude and duration are within the protocol's ranges.
bool is_valid(const protocol::CommandReport& command);

/// Returns the command of an output report, or std::nullopt if the report is invalid.
std::optional<protocol::CommandReport> decode_command(std::span<const std::byte> report);

/// Command queue from the main loop to the control interrupt. The interrupt removes one command per control period.
class CommandQueue {
 public:
  static constexpr std::uint32_t capacity = 8;

  // ---- main loop ----

  /// Returns false if the queue is full.
  bool has_room() const { return pushed_.load() - taken_.load() != capacity; }

  /// Queues a decoded command and restarts the host timeout. Returns false if the queue is full.
  [[nodiscard]] bool push(const protocol::CommandReport& command);

  /// Restarts the host timeout without a command.
  void note_sign_of_life() { sign_of_life_.store(true); }

  /// Number of commands queued since start-up.
  std::uint32_t pushed() const { return pushed_.load(); }
  /// Returns true if the interrupt has removed at least `pushed` commands.
  bool was_taken(std::uint32_t pushed) const { return static_cast<std::int32_t>(taken_.load() - pushed) >= 0; }

  /// Returns true if the queue contains this command.
  bool waiting(protocol::Command command) const;

  /// Discards the queued commands. Call this function when the connection to the host is lost. The next pop() returns a
  /// stop command, for which is_of_gone_host() is true.
  void host_gone();

  // ---- control interrupt ----

  /// Returns true if a host report arrived since the previous call. If the result is true, the interrupt calls
  /// Controller::host_alive().
  bool take_sign_of_life() {
    const bool seen = sign_of_life_.load();
    if (seen) sign_of_life_.store(false);
    return seen;
  }

  /// Returns the command for this control period, or null. The command is valid until the interrupt returns.
  const protocol::CommandReport* pop();

  /// Returns true if `command` is the stop command of host_gone().
  bool is_of_gone_host(const protocol::CommandReport& command) const { return &command == &stop_; }

  /// Token of the last removed command, for PoseReport::command_token.
  std::uint8_t last_token() const { return last_token_; }

 private:
  std::array<protocol::CommandReport, capacity> commands_;
  Shared<std::uint32_t> pushed_{0};     ///< written by the main loop
  Shared<std::uint32_t> taken_{0};      ///< written by the interrupt
  Shared<std::uint32_t> forgotten_{0};  ///< commands before this number are discarded if `host_gone_` is set
  Shared<bool> host_gone_{false};
  Shared<bool> sign_of_life_{false};
  std::uint8_t last_token_ = 0;
  protocol::CommandReport stop_{.command = protocol::Command::stop};  ///< stop command of host_gone()
};

}  // namespace inkwell::link
