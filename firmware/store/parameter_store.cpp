#include "firmware/store/parameter_store.hpp"

#include <cstddef>

namespace inkwell::link {

ParameterStore::ParameterStore()
    : values_(image_defaults()), settings_{control::prepare(values())}, settings_sum_{sum_of(settings_.used())} {}

bool ParameterStore::settings_are_intact() const {
  return settings_.is_offered() || sum_of(settings_.used()) == settings_sum_;
}

// A damaged parameter set is not replaced. The background check then detects the damage.
control::Settings* ParameterStore::next_settings_slot() { return values_.is_intact() ? settings_.next() : nullptr; }

void ParameterStore::offer(control::Settings& slot, const protocol::ParameterSet& set) {
  values_.put(set);
  slot = control::prepare(set);
  settings_sum_ = sum_of(slot);
  settings_.offer();
}

void ParameterStore::start_with(const protocol::ParameterSet& set) {
  offer(*settings_.next(), set);
  settings_.swap_if_offered();
}

bool ParameterStore::restore_defaults() {
  control::Settings* next = next_settings_slot();
  if (next != nullptr) offer(*next, image_defaults());
  return next != nullptr;
}

protocol::Refusal ParameterStore::accept(std::span<const std::byte> report, bool force_is_on,
                                         const Guarded<protocol::ParameterSet>* stored) {
  ++transactions_;
  ticket_ = header_of(report).ticket;
  ParameterCheck check;
  control::Settings* next = next_settings_slot();
  if (next == nullptr || (stored != nullptr && !stored->is_intact()))
    check.refusal = protocol::Refusal::busy;
  else
    check = check_transaction(report, values(), force_is_on, stored != nullptr ? &stored->value() : nullptr);

  refusal_ = check.refusal;
  refused_id_ = check.parameter_id;
  refused_value_ = check.value;
  if (refusal_ == protocol::Refusal::accepted) offer(*next, check.set);
  return refusal_;
}

void ParameterStore::refuse(std::span<const std::byte> report) {
  ++transactions_;
  ticket_ = header_of(report).ticket;
  refusal_ = protocol::Refusal::not_the_driver;
  refused_id_ = 0;
  refused_value_ = 0.0f;
}

std::size_t read_set(const protocol::ParameterSet& set, protocol::ReportId id, protocol::ParameterOperation operation,
                     protocol::ParametersReport& report) {
  report.report_id = id;
  report.operation = operation;
  report.version = protocol::protocol_version;
  report.count = static_cast<std::uint16_t>(image_parameter_count());
  report.ticket = 0;
  report.claim = 0;
  for (std::size_t i = 0; i < report.count; ++i) report.entries[i] = {image_parameter_id(i), 0, set.values[i]};
  return protocol::parameters_report_size(report.count);
}

std::size_t ParameterStore::read(protocol::ParametersReport& report) const {
  return read_set(values(), protocol::ReportId::parameters, protocol::ParameterOperation::set, report);
}

protocol::TransactionReport ParameterStore::result() const {
  protocol::TransactionReport report;
  report.report_id = protocol::ReportId::transaction;
  report.refusal = refusal_;
  report.parameter_id = refused_id_;
  report.value = refused_value_;
  report.transactions = transactions_;
  report.applied_at_periods = applied_at_periods_.load();
  report.ticket = ticket_;
  report.reserved = 0;
  return report;
}

}  // namespace inkwell::link
