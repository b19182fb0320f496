// A selection of signals, prepared so that recording a sample takes few instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <protocol/scope.hpp>

namespace inkwell::link {

struct ScopePlan {
  /// One selected signal: its place in SignalValues, and the steps of one unit where it goes as int16.
  struct Item {
    std::uint16_t index = 0;
    std::uint16_t narrow = 0;      ///< 1 if it goes as a 16-bit number
    float steps_per_unit = 0.0f;
  };

  std::array<Item, protocol::scope_signals_maximum> items{};
  std::uint32_t count = 0;                ///< 0: the scope is off
  std::uint32_t sample_size_maximum = 0;  ///< bytes, the mask of a `changes` sample included
  protocol::ScopeEncoding encoding = protocol::ScopeEncoding::full;
  std::uint8_t token = 0;                 ///< of the command that asked for it
};

/// `selection` holds known signals only (decode_command sees to that).
ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token);

}  // namespace inkwell::link
