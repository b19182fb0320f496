// Reads feature reports and validates them.
#pragma once

#include <cstddef>
#include <span>

#include "host/client/device/device.hpp"
#include "host/client/device/transport.hpp"
#include "protocol/reports.hpp"

namespace inkwell::device {

template <class Report>
std::span<std::byte> writable_bytes(Report& report) {
  return std::as_writable_bytes(std::span(&report, 1));
}

/// The error for a report of `length` bytes.
Incompatible too_short(const char* what, std::size_t length, std::size_t wanted);

/// Reads the information report. The protocol version of the device may differ. In this case, only members at the same
/// position are read, and the rest is 0. Throws Incompatible if these members are missing.
protocol::InformationReport read_information(Transport& transport);

}  // namespace inkwell::device
