// The parameters: checked and prepared in the main loop, taken whole at the start of a control period.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <control/settings.hpp>
#include <link/guarded.hpp>
#include <link/handover.hpp>
#include <link/parameter_check.hpp>
#include <link/shared.hpp>
#include <protocol/reports.hpp>

namespace inkwell::link {

/// The ParametersReport that tells this set; returns the bytes of it that are used.
std::size_t read_set(const protocol::ParameterSet& set, protocol::ReportId id, protocol::ParameterOperation operation,
                     protocol::ParametersReport& report);

/// Holds the parameters, and hands the settings prepared from them over to the interrupt.
class ParameterStore {
 public:
  /// Starts with the defaults of the table and of the force law.
  ParameterStore();

  /// Before the control interrupt runs: with these instead, which are sound.
  void start_with(const protocol::ParameterSet& set);

  // ---- main loop ----

  /// Checks a ParametersReport and, if it is sound, offers its settings to the interrupt. A refused one
  /// changes nothing but result(). `busy` while the transaction before has not been taken yet, and for good where a bit
  /// of a set has changed by itself, which the background watch tells. `stored` is what restore_stored gives; null is
  /// nothing.
  protocol::Refusal accept(std::span<const std::byte> report, bool force_is_on,
                           const Guarded<protocol::ParameterSet>* stored = nullptr);

  /// Refuses a ParametersReport of a program that does not drive the arm.
  void refuse(std::span<const std::byte> report);

  /// Without a transaction, while the force is off. False, and nothing done, where accept() would be busy.
  [[nodiscard]] bool restore_defaults();

  /// Every parameter of the table and of the force law, in this order; returns the bytes of the report that are used.
  std::size_t read(protocol::ParametersReport& report) const;

  /// What became of the last transaction.
  protocol::TransactionReport result() const;

  const protocol::ParameterSet& values() const { return values_.value(); }
  /// With the sum by which they were accepted.
  const Guarded<protocol::ParameterSet>& guarded_values() const { return values_; }
  /// Whether they are bit for bit those that were accepted.
  bool values_are_intact() const { return values_.is_intact(); }

  /// Whether the interrupt's settings are bit for bit those that were prepared. True while others wait to be taken.
  bool settings_are_intact() const;

  // ---- control interrupt ----

  /// Called once at the start of a control period; swaps if there is a transaction to take, and tells whether it did.
  bool take(std::uint32_t periods) {
    const bool changed = settings_.take();
    if (changed) applied_at_periods_.store(periods);
    return changed;
  }
  const control::Settings& settings() const { return settings_.used(); }

 private:
  control::Settings* place_of_next();
  void offer(control::Settings& place, const protocol::ParameterSet& set);

  Guarded<protocol::ParameterSet> values_;
  Handover<control::Settings> settings_;
  std::uint32_t settings_sum_;  ///< of the newest
  Shared<std::uint32_t> applied_at_periods_{0};
  protocol::Refusal refusal_ = protocol::Refusal::accepted;
  std::uint16_t refused_id_ = 0;
  float refused_value_ = 0.0f;
  std::uint32_t transactions_ = 0;
  std::uint16_t ticket_ = 0;  ///< of the last transaction
};

}  // namespace inkwell::link
