// The force law that an image was built with: its rows join the tables of this program.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <protocol/reports.hpp>

namespace inkwell::device {

struct ForceLaw {
  /// As the device sent it, with its texts made plain. The texts of all rows lie in it.
  std::shared_ptr<const std::vector<std::byte>> report;
  std::string_view name;  ///< of its file and struct
  std::string_view help;
  std::vector<protocol::ParameterInfo> parameters;
  std::vector<protocol::SignalInfo> signals;
};

/// Reads a protocol::ForceLawReport. Throws Error if it is damaged.
ForceLaw parse_force_law(std::span<const std::byte> report);

/// Puts the law's rows behind those of the tables: info(), known_parameters() and known_signals() give them, as
/// find_parameter() and find_signal() do by name. A law without rows has the tables as they are. False, and nothing
/// changes, while another law is in use, which is as long as somebody holds a `report` with which it joined.
bool join_tables(const ForceLaw& law);

/// The name of the law whose rows are in the tables; empty if there is none.
std::string joined_force_law();

}  // namespace inkwell::device
