// A selection of signals, prepared so that recording a sample takes few instructions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <protocol/scope.hpp>

namespace inkwell::link {

struct ScopePlan {
  /// Flag in an item of a signal that goes as a 16-bit number; below it stands the place in SignalValues.
  static constexpr std::uint8_t narrow = 0x80;
  static_assert(protocol::signal_count <= narrow);

  std::array<std::uint8_t, protocol::scope_signals_maximum> items{};
  std::array<float, protocol::scope_signals_maximum> steps_per_unit{};  ///< of the narrow items
  std::uint32_t count = 0;                ///< 0: the scope is off
  std::uint32_t sample_size_maximum = 0;  ///< bytes, the mask of a `changes` sample included
  protocol::ScopeEncoding encoding = protocol::ScopeEncoding::full;
  std::uint8_t token = 0;                 ///< of the command that asked for it
};

/// `selection` holds known signals only (decode_command sees to that).
ScopePlan prepare(const protocol::SignalSelection& selection, std::uint8_t token);

}  // namespace inkwell::link
