// Checks a parameter transaction before the values take effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/reports.hpp"

namespace inkwell::link {

/// Number of parameters of the table and of this image's force law.
std::size_t image_parameter_count();
/// Returns the protocol id of a parameter.
std::uint16_t image_parameter_id(std::size_t index);
/// Returns the index of the parameter with this protocol id.
std::optional<std::size_t> image_parameter_index(std::uint16_t id);
protocol::ParameterSet image_defaults();

/// Stored parameter values, possibly from another firmware version. A value that this firmware refuses is replaced by
/// its default.
class StoredSet {
 public:
  StoredSet() : set_(image_defaults()) {}
  void put(std::size_t index, float value);
  /// Replaces contradicting bounds by their defaults. Call this function after the last put().
  void make_consistent();
  /// Number of values replaced by their default.
  std::uint16_t refused() const { return refused_; }
  const protocol::ParameterSet& set() const { return set_; }

 private:
  protocol::ParameterSet set_;
  std::uint16_t refused_ = 0;
};

/// The bytes of a ParametersReport before its entries.
struct TransactionHeader {
  protocol::ReportId report_id;
  protocol::ParameterOperation operation;
  std::uint16_t version;
  std::uint16_t count;
  std::uint16_t ticket;
  std::uint32_t claim;
};

/// Returns the header of a ParametersReport. Missing bytes are zero.
TransactionHeader header_of(std::span<const std::byte> report);

/// Result of a transaction. `set` is valid if `refusal` is `accepted`.
struct ParameterCheck {
  protocol::Refusal refusal = protocol::Refusal::accepted;
  std::uint16_t parameter_id = 0;  ///< id of the refused parameter, otherwise 0
  float value = 0.0f;              ///< refused value, otherwise 0
  protocol::ParameterSet set{};
};

/// Applies a ParametersReport to `current` and checks the resulting parameter set as a whole.
///
/// `report` starts at the report id. Bytes after the last entry are ignored, because Windows pads feature reports.
/// While the force is on, a change of a parameter with needs_force_off is refused. `stored` is the parameter set for
/// restore_stored, or null.
ParameterCheck check_transaction(std::span<const std::byte> report, const protocol::ParameterSet& current,
                                 bool force_is_on, const protocol::ParameterSet* stored = nullptr);

}  // namespace inkwell::link
