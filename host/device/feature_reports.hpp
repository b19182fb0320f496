// Feature reports as a device sends them, judged before they are believed.
#pragma once

#include <cstddef>
#include <span>

#include <device/device.hpp>
#include <device/transport.hpp>
#include <protocol/reports.hpp>

namespace inkwell::device {

template <class Report>
std::span<std::byte> writable_bytes(Report& report) {
  return std::as_writable_bytes(std::span(&report, 1));
}

/// The sentence for a report that has `length` bytes.
Incompatible too_short(const char* what, std::size_t length, std::size_t wanted);

/// Of a device of another version only what has the same place there; the rest is 0. Throws Incompatible if not even
/// that came.
protocol::InformationReport read_information(Transport& transport);

}  // namespace inkwell::device
