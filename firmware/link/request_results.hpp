// Stores request results for RequestResultsReport.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/link/command_queue.hpp"
#include "protocol/driver.hpp"

namespace inkwell::link {

/// Stores the newest requests with a ticket. Only the main loop uses this class.
class RequestResults {
 public:
  explicit RequestResults(const CommandQueue& queue) : queue_(queue) {}

  /// Call this function directly after the command has been queued.
  void note_queued(const protocol::CommandReport& command) {
    note(entry_of(command, protocol::RequestResult::waiting), queue_.pushed());
  }
  /// Records a command that the board dropped.
  void note_dropped(const protocol::CommandReport& command, protocol::RequestResult result) {
    note(entry_of(command, result), 0);
  }
  void note_shapes(std::uint32_t ticket, protocol::RequestResult result) {
    note({ticket, protocol::ReportId::shapes, {}, result, 0}, 0);
  }
  /// Erases all results. Call this function when the connection to the host is lost.
  void forget() { requests_ = {}; }

  /// `state` and `now_periods` are values of the newest control period.
  protocol::RequestResultsReport report(protocol::State state, std::uint32_t now_periods) const;

 private:
  struct Noted {
    protocol::RequestResultEntry entry{};
    std::uint32_t pushed = 0;  ///< CommandQueue::pushed() directly after this command was queued
  };

  static protocol::RequestResultEntry entry_of(const protocol::CommandReport& command, protocol::RequestResult result) {
    return {command.ticket, protocol::ReportId::command, command.command, result, 0};
  }
  void note(const protocol::RequestResultEntry& entry, std::uint32_t pushed);

  const CommandQueue& queue_;
  std::array<Noted, protocol::request_results_kept> requests_{};
  std::size_t next_ = 0;
};

}  // namespace inkwell::link
