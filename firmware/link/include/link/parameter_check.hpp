// Checks of one transaction of parameters, before any of it takes effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <protocol/reports.hpp>

namespace inkwell::link {

/// Parameters of this image: those of the table, then those of its force law.
std::size_t image_parameter_count();
/// On the wire, of one of them.
std::uint16_t image_parameter_id(std::size_t index);
protocol::ParameterSet image_defaults();

/// What became of a transaction: `set` is valid if `refusal` is accepted.
struct ParameterCheck {
  protocol::Refusal refusal = protocol::Refusal::accepted;
  std::uint16_t parameter_id = 0;  ///< the one that was refused, else 0
  float value = 0.0f;              ///< the value that was refused, else 0
  protocol::ParameterSet set{};
};

/// Applies a ParametersReport to `current` and checks the result as a whole.
///
/// `report` starts at the report id. It holds exactly the entries that it counts, or is padded to the
/// whole ParametersReport, as Windows does with feature reports. While the force is on, a transaction
/// that changes a parameter of the group "arm" is refused.
ParameterCheck check_transaction(std::span<const std::byte> report, const protocol::ParameterSet& current,
                                 bool force_is_on);

}  // namespace inkwell::link
