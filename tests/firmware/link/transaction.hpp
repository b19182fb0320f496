// Builds ParametersReports as a host sends them.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>

#include <protocol/reports.hpp>

namespace inkwell::test {

class Transaction {
 public:
  Transaction(std::initializer_list<protocol::ParameterEntry> entries) {
    report_.operation = protocol::ParameterOperation::set;
    report_.count = 0;
    for (const protocol::ParameterEntry& entry : entries) report_.entries[report_.count++] = entry;
  }

  protocol::ParametersReport& report() { return report_; }

  std::span<const std::byte> bytes() const { return bytes(protocol::parameters_report_size(report_.count)); }
  std::span<const std::byte> bytes(std::size_t size) const { return std::as_bytes(std::span(&report_, 1)).first(size); }

 private:
  protocol::ParametersReport report_{};
};

inline protocol::ParameterEntry entry(protocol::Parameter parameter, float value) {
  return {protocol::info(parameter).id, 0, value};
}

}  // namespace inkwell::test
