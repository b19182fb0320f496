// Parameter sets. The main loop checks and prepares a parameter set. The control interrupt accepts a complete set at
// the start of a control period.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/control/settings.hpp"
#include "firmware/exchange/guarded.hpp"
#include "firmware/exchange/handover.hpp"
#include "firmware/exchange/shared.hpp"
#include "firmware/store/parameter_check.hpp"
#include "protocol/reports.hpp"

namespace inkwell::link {

/// Writes a set of parameters to a ParametersReport. Returns the number of used bytes in the report.
std::size_t read_set(const protocol::ParameterSet& set, protocol::ReportId id, protocol::ParameterOperation operation,
                     protocol::ParametersReport& report);

/// Stores the parameters, computes the settings, and passes the settings to the interrupt.
class ParameterStore {
 public:
  /// Sets the parameters to the defaults of the parameter table and of the force law.
  ParameterStore();

  /// Replaces the defaults by a valid set. Call this function before the control interrupt starts.
  void start_with(const protocol::ParameterSet& set);

  // ---- main loop ----

  /// Checks a ParametersReport and offers the settings of a valid report to the interrupt. A refused report changes
  /// only result(). `stored` is the parameter set for restore_stored, or null.
  ///
  /// Returns `busy` while the interrupt has not accepted the previous transaction. Returns `busy` if a bit of a
  /// parameter set has flipped.
  protocol::Refusal accept(std::span<const std::byte> report, bool force_is_on,
                           const Guarded<protocol::ParameterSet>* stored = nullptr);

  /// Refuses a ParametersReport from a program that is not the driver.
  void refuse(std::span<const std::byte> report);

  /// Restores the defaults without a transaction. The force must be off. Returns false and has no effect if accept()
  /// would return `busy`.
  [[nodiscard]] bool restore_defaults();

  /// Writes all parameters of the table, followed by the parameters of the force law. Returns the number of used bytes
  /// in the report.
  std::size_t read(protocol::ParametersReport& report) const;

  /// Result of the last transaction.
  protocol::TransactionReport result() const;

  const protocol::ParameterSet& values() const { return values_.value(); }
  /// Values with their checksum.
  const Guarded<protocol::ParameterSet>& guarded_values() const { return values_; }
  /// Returns true if no bit of the accepted values has flipped.
  bool values_are_intact() const { return values_.is_intact(); }

  /// Returns true if no bit of the interrupt's settings has flipped. The settings are not checked while a transaction
  /// is waiting for the interrupt.
  bool settings_are_intact() const;

  // ---- control interrupt ----

  /// Applies a transaction if one is offered. Returns true if a transaction was applied. Call this function once at the
  /// start of a control period.
  bool apply_offered(std::uint32_t periods) {
    const bool changed = settings_.swap_if_offered();
    if (changed) applied_at_periods_.store(periods);
    return changed;
  }
  const control::Settings& settings() const { return settings_.used(); }

 private:
  control::Settings* next_settings_slot();
  void offer(control::Settings& slot, const protocol::ParameterSet& set);

  Guarded<protocol::ParameterSet> values_;
  Handover<control::Settings> settings_;
  std::uint32_t settings_sum_;  ///< checksum of the newest settings
  Shared<std::uint32_t> applied_at_periods_{0};
  protocol::Refusal refusal_ = protocol::Refusal::accepted;
  std::uint16_t refused_id_ = 0;
  float refused_value_ = 0.0f;
  std::uint32_t transactions_ = 0;
  std::uint16_t ticket_ = 0;  ///< ticket of the last transaction
};

}  // namespace inkwell::link
