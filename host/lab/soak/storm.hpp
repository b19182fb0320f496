// Random parameter transactions, legal and illegal, from the ranges and bounds of the table. Without side effects.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/client/device/device.hpp"
#include "host/lab/soak/random.hpp"
#include "protocol/parameters.hpp"

namespace inkwell::soak {

using Changes = std::vector<device::ParameterChange>;

enum class Reach : std::uint8_t {
  /// Values that cause no false faults while the force is on. The dimensions of the arm do not change, and walls stay
  /// near their default positions. Resistances stay within 10 % of the correct values, because the motor check uses
  /// them. Gains are 0.5 to 1.2 times their defaults, because higher gains may cause oscillation. Speed limit and host
  /// time-out stay above the values in use, and at least 4 V remain to drive currents.
  careful,
  whole,  ///< all values that the table allows
};

/// Returns the known parameters that may be changed.
std::vector<protocol::Parameter> within(Reach reach);
struct Range {
  float minimum, maximum;
};
Range range_of(protocol::Parameter parameter, Reach reach);

protocol::ParameterSet with(protocol::ParameterSet set, std::span<const device::ParameterChange> changes);

/// Returns changes of at least `count` parameters, without contradictory bounds. `now` contains the values of the
/// device.
Changes legal_changes(Random& random, const protocol::ParameterSet& now, Reach reach, std::size_t count);

struct Illegal {
  Changes changes;  ///< legal changes plus one that causes a refusal of the transaction
  protocol::Refusal refusal;
};
Illegal illegal_changes(Random& random, const protocol::ParameterSet& now, bool force_is_on);

}  // namespace inkwell::soak
