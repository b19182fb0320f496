// Prepared selection of signals for the scope.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/scope.hpp"

namespace inkwell::link {

/// Signals that one mask of a `changes` sample describes.
struct ScopeGroup {
  std::array<std::uint8_t, protocol::scope_signals_maximum> items{};    ///< indices in SignalValues
  std::array<float, protocol::scope_signals_maximum> steps_per_unit{};  ///< for signals in 16-bit encoding
  /// The signals form alternating runs of floats and 16-bit integers. The first run has floats and may be empty. Each
  /// entry is the end index of one run. The entry after the last run is 0.
  std::array<std::uint8_t, protocol::scope_signals_maximum + 2> run_ends{};
  std::uint32_t count = 0;
};

struct ScopePlan {
  ScopeGroup fast{};                      ///< signals of every period; empty: the scope is off
  ScopeGroup slow{};                      ///< signals of each scope_slow_interval-th sample
  std::uint32_t sample_size_maximum = 0;  ///< bytes, including the mask of a `changes` sample
  protocol::ScopeEncoding encoding = protocol::ScopeEncoding::full;
  std::uint8_t token = 0;  ///< token of the select_signals command
};

/// `selection` must contain only known signals and must not be an empty bit mask.
ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token);

}  // namespace inkwell::link
