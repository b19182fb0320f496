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

/// One period of the scope, in the interrupt and in the main loop.
inline void record(link::ScopeRecorder& scope, const protocol::SignalValues& signals, std::uint32_t period) {
  scope.next() = signals;
  scope.record(period);
  scope.pack();
}

}  // namespace inkwell::test
