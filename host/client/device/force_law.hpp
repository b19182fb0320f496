// The force law of a firmware image, whose rows are added to the tables of this program.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/reports.hpp"

namespace inkwell::device {

struct ForceLaw {
  /// The report of the device without unprintable characters. The texts of all rows point into this report.
  std::shared_ptr<const std::vector<std::byte>> report;
  std::string_view name;  ///< name of its file and struct
  std::string_view help;
  std::vector<protocol::ParameterInfo> parameters;
  std::vector<protocol::SignalInfo> signals;
};

/// Reads a protocol::ForceLawReport. Throws Error if the report is damaged.
ForceLaw parse_force_law(std::span<const std::byte> report);

/// Appends the rows of the law to the tables, so that info(), known_parameters(), known_signals(), find_parameter() and
/// find_signal() include them. Returns false and changes nothing while another law is in use. A law is in use while a
/// `report` of this law exists.
bool join_tables(const ForceLaw& law);

/// The name of the law in the tables; empty if there is none.
std::string joined_force_law();

}  // namespace inkwell::device
