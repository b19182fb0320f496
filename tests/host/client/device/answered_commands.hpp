// Answers commands and shapes like a board.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

#include "protocol/driver.hpp"

namespace inkwell::tests {

/// Every command is executed as soon as it is written.
class AnsweredCommands {
 public:
  void note(std::span<const std::byte> written) { put(written, protocol::RequestResult::carried_out); }
  /// Refuses a command of a program that is not the driver.
  void refuse(std::span<const std::byte> written) { put(written, protocol::RequestResult::not_the_driver); }

  void note_shapes(std::span<const std::byte> written, protocol::RequestResult result) {
    protocol::ShapesReport shapes{};
    std::memcpy(&shapes, written.data(), std::min(written.size(), sizeof shapes));
    add({shapes.ticket, protocol::ReportId::shapes, {}, result, 0});
  }

  /// Writes the RequestResultsReport if the host requests that report.
  std::size_t answer(std::span<std::byte> asked) const {
    if (asked[0] != static_cast<std::byte>(protocol::ReportId::request_results)) return 0;
    std::memcpy(asked.data(), &report, std::min(asked.size(), sizeof report));
    return sizeof report;
  }

  protocol::RequestResultsReport report{.state = protocol::State::ready};

 private:
  void put(std::span<const std::byte> written, protocol::RequestResult result) {
    protocol::CommandReport command{};
    std::memcpy(&command, written.data(), std::min(written.size(), sizeof command));
    if (command.report_id != protocol::ReportId::command || command.ticket == 0) return;
    add({command.ticket, command.report_id, command.command, result, 0});
  }
  void add(const protocol::RequestResultEntry& entry) { report.entries[next_++ % std::size(report.entries)] = entry; }

  std::size_t next_ = 0;
};

}  // namespace inkwell::tests
