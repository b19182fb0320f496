#include <link/command_results.hpp>

namespace inkwell::link {

using protocol::CommandResult;

void CommandResults::note(const protocol::CommandReport& command, CommandResult result, std::uint32_t pushed) {
  if (command.ticket == 0) return;
  commands_[next_] = {{command.ticket, command.command, result, 0}, pushed};
  next_ = (next_ + 1) % commands_.size();
}

protocol::CommandResultsReport CommandResults::report(protocol::State state, std::uint32_t now_periods) const {
  protocol::CommandResultsReport report{};
  report.state = state;
  report.time_periods = now_periods;
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    report.entries[i] = commands_[i].entry;
    // The control interrupt finishes its period before the main loop reads this.
    if (report.entries[i].result == CommandResult::waiting && queue_.was_taken(commands_[i].pushed))
      report.entries[i].result = CommandResult::carried_out;
  }
  return report;
}

}  // namespace inkwell::link
