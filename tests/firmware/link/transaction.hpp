// Builds the ParametersReports of a host, and flips bits of values.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "protocol/reports.hpp"

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

/// Returns a report whose bytes are all 0xFF.
inline protocol::ParametersReport spoiled_report() {
  std::array<std::byte, sizeof(protocol::ParametersReport)> bytes;
  bytes.fill(std::byte{0xFF});
  return std::bit_cast<protocol::ParametersReport>(bytes);
}

/// Flips one bit of a value, as radiation can do.
inline void flip_bit(const float& value, unsigned bit = 20) {
  const_cast<float&>(value) = std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ 1u << bit);
}

}  // namespace inkwell::test
