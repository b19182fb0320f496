// A selection of signals, prepared so that recording a sample takes few instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <protocol/scope.hpp>

namespace inkwell::link {

struct ScopePlan {
  std::array<std::uint8_t, protocol::scope_signals_maximum> items{};    ///< places in SignalValues
  std::array<float, protocol::scope_signals_maximum> steps_per_unit{};  ///< where it goes as a 16-bit number
  /// The items fall into runs that go alternately as floats and as 16-bit numbers, floats first (none, if the
  /// first item is narrow). Each entry is the number of items up to the end of its run, 0 behind the last run.
  std::array<std::uint8_t, protocol::scope_signals_maximum + 2> run_ends{};
  std::uint32_t count = 0;                ///< 0: the scope is off
  std::uint32_t sample_size_maximum = 0;  ///< bytes, the mask of a `changes` sample included
  protocol::ScopeEncoding encoding = protocol::ScopeEncoding::full;
  std::uint8_t token = 0;  ///< of the command that asked for it
};

/// `selection` holds known signals only (decode_command sees to that).
ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token);

}  // namespace inkwell::link
