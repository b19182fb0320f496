#include "firmware/link/request_results.hpp"

namespace inkwell::link {

using protocol::RequestResult;

void RequestResults::note(const protocol::RequestResultEntry& entry, std::uint32_t pushed) {
  if (entry.ticket == 0) return;
  requests_[next_] = {entry, pushed};
  next_ = (next_ + 1) % requests_.size();
}

protocol::RequestResultsReport RequestResults::report(protocol::State state, std::uint32_t now_periods) const {
  protocol::RequestResultsReport report{};
  report.state = state;
  report.time_periods = now_periods;
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    report.entries[i] = requests_[i].entry;
    // The control interrupt removes and executes a command in one call, so each removed command has been executed.
    if (report.entries[i].result == RequestResult::waiting && queue_.was_taken(requests_[i].pushed))
      report.entries[i].result = RequestResult::carried_out;
  }
  return report;
}

}  // namespace inkwell::link
