// Commands on their way from the host to the control interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <link/shared.hpp>
#include <protocol/reports.hpp>

namespace inkwell::link {

/// The command in an output report (from its report id on), valid or not; nothing if the length, id or version differs.
std::optional<protocol::CommandReport> whole_command(std::span<const std::byte> report);

/// Whether the command, signals, motor, amplitude and duration are within the protocol.
bool is_valid(const protocol::CommandReport& command);

/// The command in an output report if it is whole and valid.
std::optional<protocol::CommandReport> decode_command(std::span<const std::byte> report);

/// Queue from the main loop to the control interrupt, which takes one command a period.
class CommandQueue {
 public:
  static constexpr std::uint32_t capacity = 8;

  // ---- main loop ----

  /// Whether push() will take a command now.
  bool has_room() const { return pushed_.load() - taken_.load() != capacity; }

  /// Queues a decoded command and notes a sign of life; false if the queue is full.
  [[nodiscard]] bool push(const protocol::CommandReport& command);

  /// The host was heard, without a command.
  void note_sign_of_life() { sign_of_life_.store(true); }

  /// Commands that were pushed since the start.
  std::uint32_t pushed() const { return pushed_.load(); }
  /// Whether the interrupt has taken the command that was the last one when pushed() returned this.
  bool was_taken(std::uint32_t pushed) const { return static_cast<std::int32_t>(taken_.load() - pushed) >= 0; }

  /// Whether such a command waits for the interrupt.
  bool waiting(protocol::Command command) const;

  /// The host is gone: what is queued is forgotten, and the interrupt's next command is a stop that is told apart from
  /// a user's.
  void host_gone();

  // ---- control interrupt ----

  /// Whether a command arrived since the last call; the controller then hears host_alive().
  bool take_sign_of_life() {
    const bool seen = sign_of_life_.load();
    if (seen) sign_of_life_.store(false);
    return seen;
  }

  /// The next command, to be carried out in this period; null if there is none. Valid until the interrupt returns.
  const protocol::CommandReport* take();

  /// Whether that is the stop of host_gone(), and not a host's own.
  bool is_of_gone_host(const protocol::CommandReport& command) const { return &command == &stop_; }

  /// Token of the last command taken, for PoseReport::command_token.
  std::uint8_t last_token() const { return last_token_; }

 private:
  std::array<protocol::CommandReport, capacity> commands_;
  Shared<std::uint32_t> pushed_{0};     ///< written by the main loop
  Shared<std::uint32_t> taken_{0};      ///< written by the interrupt
  Shared<std::uint32_t> forgotten_{0};  ///< what was pushed before is forgotten, if `host_gone_`
  Shared<bool> host_gone_{false};
  Shared<bool> sign_of_life_{false};
  std::uint8_t last_token_ = 0;
  protocol::CommandReport stop_{.command = protocol::Command::stop};  ///< for a host that is gone
};

}  // namespace inkwell::link
