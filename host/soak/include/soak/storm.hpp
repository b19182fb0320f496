// Random transactions of parameters, legal and illegal, by the table's own ranges and bounds. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <device/device.hpp>
#include <protocol/parameters.hpp>
#include <soak/random.hpp>

namespace inkwell::soak {

using Changes = std::vector<device::ParameterChange>;

enum class Reach : std::uint8_t {
  /// With the force on a sound arm stays sound: no measure of the arm; walls stay about where they are by default;
  /// resistances within a tenth (the motors' watch judges by them), gains from half to 1.2 times what they were
  /// (beyond,
  /// the loops may ring), a speed limit and a host's timeout that use keeps below, and 4 V or more to drive currents.
  careful,
  whole,  ///< every value that the table allows
};

/// Parameters that may be changed at all, of those that are known.
std::vector<protocol::Parameter> within(Reach reach);
/// The smallest and the largest value.
struct Range {
  float minimum, maximum;
};
Range range_of(protocol::Parameter parameter, Reach reach);

protocol::ParameterSet with(protocol::ParameterSet set, std::span<const device::ParameterChange> changes);

/// `count` parameters at least, no bounds contradicted. `now` is what the device holds.
Changes legal_changes(Random& random, const protocol::ParameterSet& now, Reach reach, std::size_t count);

struct Illegal {
  Changes changes;  ///< legal ones with one among them that makes the whole be refused
  protocol::Refusal refusal;
};
Illegal illegal_changes(Random& random, const protocol::ParameterSet& now, bool force_is_on);

}  // namespace inkwell::soak
