// One Link for all tests, made new for each: its scope frames fill half of the chip's memory.
#pragma once

#include <cstdint>
#include <new>

#include <link/link.hpp>

namespace inkwell::test {

inline constexpr std::uint32_t cycles_per_period = 8400;

inline link::Link& fresh_link() {
  static link::ScopeFrames frames;
  alignas(link::Link) static std::byte storage[sizeof(link::Link)];
  return *new (storage) link::Link(cycles_per_period, frames);
}

/// What the interrupt leaves of one period.
inline void interrupt(link::Link& link, const protocol::SignalValues& signals, const link::PeriodSummary& summary) {
  link.samples.next() = {signals, summary};
  link.samples.record();
}
inline void interrupt(link::Link& link, const protocol::SignalValues& signals, std::uint32_t period) {
  interrupt(link, signals, {.state = protocol::State::ready, .periods = period});
}

/// One period of the scope, in the interrupt and in the main loop.
inline void record(link::Link& link, const protocol::SignalValues& signals, std::uint32_t period) {
  interrupt(link, signals, period);
  link.scope.pack();
}

}  // namespace inkwell::test
