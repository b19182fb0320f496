// The results of commands, for the programs that sent them.
#pragma once

#include <array>
#include <cstdint>

#include <link/command_queue.hpp>
#include <protocol/driver.hpp>

namespace inkwell::link {

/// The newest commands that have a ticket. Main loop only.
class CommandResults {
 public:
  explicit CommandResults(const CommandQueue& queue) : queue_(queue) {}

  /// The command has just been queued.
  void note_queued(const protocol::CommandReport& command) {
    note(command, protocol::CommandResult::waiting, queue_.pushed());
  }
  /// The command was refused, because its program does not drive the arm.
  void note_refused(const protocol::CommandReport& command) {
    note(command, protocol::CommandResult::not_the_driver, 0);
  }
  /// The host is gone, and with it the commands that waited.
  void forget() { commands_ = {}; }

  /// `state` and `now_periods`: of the newest control period.
  protocol::CommandResultsReport report(protocol::State state, std::uint32_t now_periods) const;

 private:
  struct Noted {
    protocol::CommandResultEntry entry{};
    std::uint32_t pushed = 0;  ///< CommandQueue::pushed() with this command as the last
  };

  void note(const protocol::CommandReport& command, protocol::CommandResult result, std::uint32_t pushed);

  const CommandQueue& queue_;
  std::array<Noted, protocol::command_results_kept> commands_{};
  std::size_t next_ = 0;
};

}  // namespace inkwell::link
