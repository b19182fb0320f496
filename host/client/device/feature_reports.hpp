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

/// Returns the error for a truncated report.
Incompatible too_short(const char* what, std::size_t length, std::size_t wanted);

/// Reads the information report of any protocol version. If the version differs, reads only the members whose positions
/// never change and sets the rest to 0. Throws Incompatible if these members are missing.
protocol::InformationReport read_information(Transport& transport);

}  // namespace inkwell::device
