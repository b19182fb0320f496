// Names of arms, such as "left" and "right". A file of the user binds each name to an address.
#pragma once

// Format of the file, inkwell/arms.toml in the configuration folder. Its order is the order of the arms:
//
//     [[arm]]
//     name = "left"
//     address = "2F0031000A51373038353635"  # serial number, or another address
//
// `control` of an entry is the address of a virtual board's control socket, "HOST:PORT" or "unix:PATH". The environment
// variable INKWELL_ARMS names another file; an empty value means that no names are known.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/client/device/address.hpp"

namespace inkwell::device {

struct NamedArm {
  std::string name;
  std::string address;    ///< in the form of parse_address(); never another name
  std::string control{};  ///< control socket of a virtual board, or empty
  bool operator==(const NamedArm&) const = default;
};

/// Longest name in bytes.
inline constexpr std::size_t longest_arm_name = 32;

/// Returns the file of the names; empty if there is none.
std::filesystem::path arm_names_file();
/// Returns the names in the order of the file. A missing file has no names. Throws Error with the line of a mistake.
std::vector<NamedArm> read_arm_names(const std::filesystem::path& file = arm_names_file());
/// Parses the file's text. `file_name` is for errors. Throws Error.
std::vector<NamedArm> parse_arm_names(std::string_view toml_text, const std::string& file_name);
/// Replaces the file. Creates its folder if necessary. Throws Error.
void write_arm_names(const std::vector<NamedArm>& arms, const std::filesystem::path& file);
/// Throws Error if a text cannot be the name of an arm: only letters, digits, spaces, `-`, `_` and `.`, and neither an
/// address nor a serial number.
void check_arm_name(std::string_view name);

/// Finds a name. Upper and lower case are equal. Returns NULL for an unknown name.
const NamedArm* find_arm_name(const std::vector<NamedArm>& arms, std::string_view name);
/// Returns "left, right", or an empty text.
std::string names_of(const std::vector<NamedArm>& arms);
/// Returns the first name of the arm with this address, or an empty text.
std::string name_of_address(const std::vector<NamedArm>& arms, std::string_view address);

/// Parses an address or a name. Throws BadAddress, or Error for a damaged file.
Address named_address(std::string_view text);

}  // namespace inkwell::device
