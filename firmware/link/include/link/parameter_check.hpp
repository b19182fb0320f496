// Checks of one transaction of parameters, before any of it takes effect.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <protocol/reports.hpp>

namespace inkwell::link {

/// Parameters of this image: those of the table, then those of its force law.
std::size_t image_parameter_count();
/// On the wire, of one of them.
std::uint16_t image_parameter_id(std::size_t index);
/// Of the one with this id on the wire.
std::optional<std::size_t> image_parameter_index(std::uint16_t id);
protocol::ParameterSet image_defaults();

/// Values that were stored, perhaps by another firmware: each that this one refuses takes its default instead.
class StoredSet {
 public:
  StoredSet() : set_(image_defaults()) {}
  void put(std::size_t index, float value);
  /// After all have been put: of a pair of bounds that contradict each other both take their default.
  void make_consistent();
  /// How many took their default.
  std::uint16_t refused() const { return refused_; }
  const protocol::ParameterSet& set() const { return set_; }

 private:
  protocol::ParameterSet set_;
  std::uint16_t refused_ = 0;
};

/// What precedes the entries of a ParametersReport.
struct TransactionHeader {
  protocol::ReportId report_id;
  protocol::ParameterOperation operation;
  std::uint16_t version;
  std::uint16_t count;
  std::uint16_t ticket;
  std::uint32_t claim;
};

/// The header of a ParametersReport; missing bytes are zero.
TransactionHeader header_of(std::span<const std::byte> report);

/// What became of a transaction: `set` is valid if `refusal` is accepted.
struct ParameterCheck {
  protocol::Refusal refusal = protocol::Refusal::accepted;
  std::uint16_t parameter_id = 0;  ///< the one that was refused, else 0
  float value = 0.0f;              ///< the value that was refused, else 0
  protocol::ParameterSet set{};
};

/// Applies a ParametersReport to `current` and checks the result as a whole.
///
/// `report` starts at the report id. Bytes after the entries that it counts are ignored: Windows pads feature reports.
/// While the force is on, a transaction that changes a parameter of the group "arm" is refused. `stored` is what
/// restore_stored gives; null is nothing.
ParameterCheck check_transaction(std::span<const std::byte> report, const protocol::ParameterSet& current,
                                 bool force_is_on, const protocol::ParameterSet* stored = nullptr);

}  // namespace inkwell::link
