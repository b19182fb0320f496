// All tests share one Link object, because its scope frames fill half of the chip's memory. The black box of the Link
// object has fewer rows than on the board, to save memory.
#pragma once

#include <cstdint>
#include <new>

#include "firmware/link/link.hpp"

namespace inkwell::test {

inline constexpr std::uint32_t cycles_per_period = 8400;
using SmallBlackBox = link::BlackBoxMemory<5, 4>;

inline link::Link& fresh_link(std::uint32_t first_period = 0) {
  static link::ScopeFrames frames;
  static SmallBlackBox black_box;
  alignas(link::Link) static std::byte storage[sizeof(link::Link)];
  alignas(link::ProgramRequests) static std::byte requests[sizeof(link::ProgramRequests)];
  black_box = {};
  auto* const fresh = new (storage)
      link::Link(cycles_per_period, *new (requests) link::ProgramRequests, frames, black_box, first_period);
  fresh->black_box.start(protocol::Fault::none, {});
  return *fresh;
}

/// Records the sample of one period, like the control interrupt.
inline void interrupt(link::Link& link, const protocol::SignalValues& signals, const link::PeriodSummary& summary) {
  link.samples.next() = {signals, summary};
  link.samples.record();
}
inline void interrupt(link::Link& link, const protocol::SignalValues& signals, std::uint32_t period) {
  interrupt(link, signals, {.state = protocol::State::ready, .periods = period});
}

/// Records the sample of one period and packs the sample for the scope.
inline void record(link::Link& link, const protocol::SignalValues& signals, std::uint32_t period) {
  interrupt(link, signals, period);
  link.scope.pack();
}

}  // namespace inkwell::test
