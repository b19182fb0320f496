// Random parameter transactions, legal and illegal. Without side effects.
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
  /// With these values a healthy arm reports no faults. The dimensions of the arm do not change, and walls stay near
  /// their default positions. Resistances stay within 10 % of the correct values, because the motor check uses them.
  /// Gains are 0.5 to 1.2 times their defaults, because higher gains may cause oscillation. Speed limit and host
  /// time-out stay above the values that the phases need.
  careful,
  whole,  ///< all values that the table allows
};

/// Returns the parameters that may change.
std::vector<protocol::Parameter> within(Reach reach);
struct Range {
  float minimum, maximum;
};
Range range_of(protocol::Parameter parameter, Reach reach);

protocol::ParameterSet with(protocol::ParameterSet set, std::span<const device::ParameterChange> changes);

/// Returns valid changes of at least `count` parameters. `now` contains the present parameters of the device.
Changes legal_changes(Random& random, const protocol::ParameterSet& now, Reach reach, std::size_t count);

struct Illegal {
  Changes changes;  ///< legal changes plus one that causes a refusal of the transaction
  protocol::Refusal refusal;
};
Illegal illegal_changes(Random& random, const protocol::ParameterSet& now, bool force_is_on);

}  // namespace inkwell::soak
