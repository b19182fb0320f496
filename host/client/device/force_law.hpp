// Adds the force law of a firmware image to the tables of this program.
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
  /// The report of the device without unprintable characters. The rows point to texts in this report.
  std::shared_ptr<const std::vector<std::byte>> report;
  std::string_view name;  ///< name of the force law's file and struct
  std::string_view help;
  std::vector<protocol::ParameterInfo> parameters;
  std::vector<protocol::SignalInfo> signals;
};

/// Parses a protocol::ForceLawReport. Throws Error if the report is damaged.
ForceLaw parse_force_law(std::span<const std::byte> report);

/// Appends the parameters and signals of `law` to the tables of this program. Returns false without a change while
/// another law is in use. A law is in use while its `report` exists.
bool join_tables(const ForceLaw& law);

/// Returns the name of the added law, or an empty text.
std::string joined_force_law();

}  // namespace inkwell::device
