// Parameter store in the flash of the board.
//
// The board loads the last stored set at start-up. One command stores the current set, and another command erases the
// stored set. Both commands are allowed only while the force is off (may_store()).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/reports.hpp"
#include "protocol/supervision.hpp"

namespace inkwell::protocol {

// clang-format off
/// X(id, name, meaning, remedy)
#define INKWELL_STORE_RESULTS(X)                                                                                       \
  X(0, none, "No parameters have been stored or erased since the board started.", "Nothing to do.")                        \
  X(1, done, "The parameters are in flash and survive a power loss.", "Nothing to do.")                                          \
  X(2, under_way, "The parameters are being written. Writing waits while the force is on.", "Read the result again after some milliseconds. If the force is on, switch it off.") \
  X(3, force_is_on, "Refused: the force is on, or a queued command will switch the force on.", "Switch the force off, wait until a running test has ended, then try again.") \
  X(4, no_room, "Refused: the flash sector is full. The next start of the board frees space.", "Switch the board off and on, or reset it. Then set the values again and store them.") \
  X(5, flash_failed, "A flash word could not be written. The previously stored parameters are still valid.", "Reset the board and try again. If the error returns, replace the chip: its flash is worn.") \
  X(6, nothing_stored, "No parameters were stored, so nothing was erased. Every parameter has its default.", "Nothing to do.")

/// X(id, name, meaning)
#define INKWELL_STORE_CONTENTS(X)                                                                                      \
  X(0, nothing, "No parameters are stored, or they cannot be read. The next start sets every parameter to its default.")  \
  X(1, parameters, "Parameters are stored, and the next start loads them.")                                                        \
  X(2, factory_reset, "A factory reset erased the stored parameters. The next start sets every parameter to its default.")     \
  X(3, other_schema, "The records were written by a firmware with another schema and cannot be read. The next start sets every parameter to its default.")
// clang-format on

/// Result of the last store or erase command.
enum class StoreResult : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_STORE_RESULTS(X)
#undef X
};

/// Kind of the newest complete record in the flash.
enum class StoreContents : std::uint8_t {
#define X(id, name, ...) name = id,
  INKWELL_STORE_CONTENTS(X)
#undef X
};

struct StoreResultInfo {
  std::string_view name;
  std::string_view meaning;
  std::string_view remedy;
};

struct StoreContentsInfo {
  std::string_view name;
  std::string_view meaning;
};

inline constexpr auto store_result_table = std::to_array<StoreResultInfo>({
#define X(id, name, meaning, remedy) {#name, meaning, remedy},
    INKWELL_STORE_RESULTS(X)
#undef X
});

inline constexpr auto store_contents_table = std::to_array<StoreContentsInfo>({
#define X(id, name, meaning) {#name, meaning},
    INKWELL_STORE_CONTENTS(X)
#undef X
});

inline constexpr StoreResultInfo unknown_store_result{"unknown",
                                                      "The device reported a result that is unknown to this companion.",
                                                      "Use the companion version that matches the firmware."};
inline constexpr StoreContentsInfo unknown_store_contents{
    "unknown", "The device reported stored contents that are unknown to this companion."};

constexpr const StoreResultInfo& info(StoreResult result) {
  const auto index = static_cast<std::size_t>(result);
  return index < store_result_table.size() ? store_result_table[index] : unknown_store_result;
}
constexpr const StoreContentsInfo& info(StoreContents contents) {
  const auto index = static_cast<std::size_t>(contents);
  return index < store_contents_table.size() ? store_contents_table[index] : unknown_store_contents;
}

namespace detail {
#define X(id, text, ...) \
  static_assert(store_result_table[id].name == std::string_view(#text), #text ": the id must be the row index");
INKWELL_STORE_RESULTS(X)
#undef X
#define X(id, text, ...) \
  static_assert(store_contents_table[id].name == std::string_view(#text), #text ": the id must be the row index");
INKWELL_STORE_CONTENTS(X)
#undef X
}  // namespace detail

/// Returns true if the board may store or erase parameters in `state`.
constexpr bool may_store(State state) {
  return state == State::unreferenced || state == State::ready || state == State::fault;
}

/// Version of the record layout. A firmware reads only records with its schema version.
inline constexpr std::uint16_t store_schema = 1;
/// Number of flash sectors. The records alternate between the sectors.
inline constexpr std::size_t store_sectors = 2;
/// The report lists at most this number of unknown parameter ids.
inline constexpr std::size_t store_unknown_ids_maximum = 16;

/// Feature report: the state of the store.
struct StoreReport {
  ReportId report_id = ReportId::store;
  StoreResult result;                          ///< result of the last command to store or to erase
  StoreContents contents;                      ///< now
  StoreContents contents_at_start;             ///< contents at start-up
  std::uint16_t differing;                     ///< parameters whose value differs from their value after the next start
  std::uint16_t stores_left;                   ///< number of records that fit before the next start, which frees space
  std::uint32_t commands;                      ///< commands to store or to erase since start-up, including refused ones
  std::uint32_t records_written;               ///< over the life of the board
  std::uint32_t sector_erases[store_sectors];  ///< over the life of the board
  std::uint8_t firmware_version[4];            ///< firmware that wrote the contents at start-up: major, minor, patch, 0
  std::uint32_t parameter_table_hash;          ///< parameter_table_hash of that firmware
  std::uint32_t force_law_hash;                ///< force_law_name_hash() of that firmware's force law
  std::uint16_t schema;                        ///< schema of the contents at start-up; 0 for `nothing`
  std::uint16_t entries;                       ///< number of parameters in the contents at start-up
  std::uint16_t out_of_range;                  ///< entries with a refused value, which have their default
  /// Entries with an unknown id. New records retain unknown entries, except for entries of another force law.
  std::uint16_t unknown;
  std::uint16_t unknown_ids[store_unknown_ids_maximum];  ///< first unknown ids, padded with 0
};

static_assert(sizeof(StoreReport) == 76);

/// Returns the FNV-1a hash of a force law's name. 0 is not the hash of any force law.
constexpr std::uint32_t force_law_name_hash(std::string_view name) { return detail::fnv1a(2166136261u, name); }

}  // namespace inkwell::protocol
